// Writes the manual pages, at build time.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "command.hpp"
#include "help.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: lobe_make_pages DIRECTORY\n";
    return 2;
  }
  for (const auto& [name, text] : lobe::cli::manual(lobe::cli::commands())) {
    const auto folder = std::filesystem::path(argv[1]) / (std::string("man") + name.back());
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / name);
    file << text;
    if (!file.flush()) {
      std::cerr << "cannot write " << folder / name << "\n";
      return 3;
    }
  }
  return 0;
}
