// Writes at build time what is made from the tables of options and from the catalogue: the manual pages, the
// schema of studies, and the reference of commands and models for the documentation site.
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/help.hpp"
#include "interface/model_page.hpp"
#include "interface/topics.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "lobe/plot/sampling_page.hpp"
#include "lobe/study/study_schema.hpp"

namespace {

namespace cli = lobe::cli;
namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_manual(const fs::path& directory) {
  for (const auto& [name, text] : cli::manual(cli::commands())) {
    write(directory / (std::string("man") + name.back()) / name, text);
  }
}

void write_commands(const fs::path& directory) {
  std::vector<std::string> names;
  for (const auto& command : cli::commands()) {
    names.emplace_back(command.name);
    write(directory / (names.back() + ".html"), cli::html_text(cli::command_page(command)));
  }
  for (const auto& topic : cli::topics()) {
    names.emplace_back(topic.name);
    write(directory / (names.back() + ".html"), cli::html_text(cli::topic_page(topic)));
  }
  write(directory / "index.html", cli::html_text(cli::lobe_page(cli::commands()), names));
}

std::string kernel_of(std::string_view model) {
  const std::string_view kernel = lobe::kernel_name(model);
  return kernel.empty() ? "" : "../kernels/models/" + std::string(kernel) + ".clh";
}

/// Endings of pictures that may be there, and what they show.
constexpr std::array<std::pair<const char*, const char*>, 3> kPictures{
    {{".png", "spheres under three point lights and under a uniform sky, beside a grey one"},
     {".reflectance.png", "values in the plane of incidence"},
     {".albedo.png", "albedo over the angle of incidence"}}};

/// \param pictures folder of NAME.png and others, as build.sh in docs/site draws them
void write_models(const fs::path& directory, const fs::path& pictures) {
  std::vector<std::string> thumbnails;
  for (const auto& model : lobe::catalogue()) {
    const std::string name(model.name);
    std::vector<cli::ModelPicture> shown;
    for (const auto& [ending, caption] : kPictures) {
      if (fs::exists(pictures / (name + ending))) shown.push_back({name + ending, caption});
    }
    thumbnails.push_back(shown.empty() ? "" : shown.front().path);
    write(directory / (name + ".html"),
          cli::html_text(model, lobe::typical_material(name).name, kernel_of(name), shown));
  }
  for (const auto& factor : lobe::factors()) {
    const std::string name(factor.name);
    write(directory / (cli::page_name(factor) + ".html"),
          cli::html_text(factor, "../kernels/factors/" + name + ".clh"));
  }
  write(directory / "index.html", cli::catalogue_html(thumbnails));
}

void print_examples() {
  for (const auto& model : lobe::catalogue()) {
    std::cout << model.name << ' ' << lobe::typical_material(model.name).name << '\n';
  }
}

/// A curve of a chart, as a study file has it.
std::string curve(const lobe::Material& material, const std::string& rest) {
  const lobe::Term& term = material.terms.front();
  std::string text = "  {model = \"" + term.model + "\"";
  const auto names = lobe::parameter_names(term);
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += ", " + names[k] + " = " + lobe::shortest(term.values[k]);
  }
  return text + rest + "},\n";
}

/// A study file that draws NAME.reflectance and NAME.albedo of every model.
void print_study() {
  std::cout << "[study]\ntitle = \"All models\"\n";
  for (const auto& model : lobe::catalogue()) {
    const std::string name(model.name);
    const lobe::Material material = lobe::typical_material(name);
    const auto begin = [&](const char* quantity, const char* title) {
      std::cout << "\n[[chart]]\nname = \"" << name << '.' << quantity << "\"\ntitle = \"" << title
                << "\"\nquantity = \"" << quantity << "\"\n";
    };
    if (!model.traits.has_delta) {
      begin("reflectance", "Reflectance in the plane of incidence");
      std::cout << "curves = [\n";
      for (const char* theta : {"0", "30", "60"}) {
        std::cout << curve(material, std::string(", theta_in = ") + theta + ", label = \"θ_in = " + theta + "°\"");
      }
      std::cout << "]\n";
    }
    begin("albedo", "Albedo");
    std::cout << "tolerance = 1e-4\ncurves = [\n" << curve(material, ", label = \"" + material.name + "\"") << "]\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 2 && arguments[0] == "manual") {
      write_manual(arguments[1]);
    } else if (arguments.size() == 3 && arguments[0] == "site") {
      write_commands(fs::path(arguments[1]) / "commands");
      write_models(fs::path(arguments[1]) / "models", arguments[2]);
    } else if (arguments.size() == 2 && arguments[0] == "schema") {
      write(arguments[1], lobe::study_schema());
    } else if (arguments.size() == 1 && arguments[0] == "examples") {
      print_examples();
    } else if (arguments.size() == 1 && arguments[0] == "study") {
      print_study();
    } else {
      std::cerr << "usage: lobe_make_pages manual DIRECTORY\n"
                   "       lobe_make_pages schema FILE\n"
                   "       lobe_make_pages site DIRECTORY PICTURES\n"
                   "       lobe_make_pages examples\n"
                   "       lobe_make_pages study\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << "lobe_make_pages: " << error.what() << "\n";
    return 3;
  }
  return 0;
}
