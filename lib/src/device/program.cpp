#include "device/program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/error.hpp"
#include "device/implementation.hpp"
#include "kernels.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::string_view kInclude = "//#include \"";  // what cmake/embed_text.cmake makes of an #include line

/// Appends a file, before it what it includes if it is a header, each file once.
void append_file(std::string_view file, std::vector<KernelFile>& appended) {
  if (std::ranges::find(appended, file, &KernelFile::name) != appended.end()) return;
  const auto text = kernels::text(file);
  if (text.empty()) throw DeviceError("no kernel file " + std::string(file) + " in this build");
  if (file.ends_with(".clh")) {
    for (auto at = text.find(kInclude); at != std::string_view::npos; at = text.find(kInclude, at + 1)) {
      const auto name = text.substr(at + kInclude.size());
      append_file(name.substr(0, name.find('"')), appended);
    }
  }
  appended.push_back({std::string(file), text});
}

}  // namespace

std::vector<KernelFile> with_includes(std::span<const std::string> files) {
  std::vector<KernelFile> all;
  for (const std::string& file : files) append_file(file, all);
  return all;
}

cl::Program build_program(const Device& device, const std::vector<KernelText>& parts, Precision precision,
                          const std::string& options) {
  auto& implementation = device.implementation();
  // -w: PoCL 3.1 tells the terminal how many warnings there are, for headers of its own.
  std::string all_options = fmt::format("-cl-std=CL1.2 -w -D REAL_BITS={} -D REAL_WIDTH={}",
                                        precision == Precision::double_precision ? 64 : 32, implementation.pack_width);
  if (!options.empty()) all_options += " " + options;
  std::string key = all_options;
  cl::Program::Sources sources;
  std::vector<KernelFile> files;
  for (const auto& part : parts) {
    if (part.file.empty()) {
      sources.push_back(part.text);
    } else {
      const std::size_t known_files = files.size();
      append_file(part.file, files);
      for (std::size_t i = known_files; i < files.size(); ++i) sources.emplace_back(files[i].text);
    }
    key += " " + part.file + part.text;
  }
  const auto known = implementation.programs.find(key);
  if (known != implementation.programs.end()) return known->second;

  const std::string what = "cannot build " + parts.back().file + " for OpenCL device " + implementation.info.name +
                           " (" + implementation.info.driver + ") with '" + all_options + "'";
  try {
    cl::Program program(implementation.context, sources);
    program.build(implementation.device, all_options.c_str());
    implementation.programs.emplace(key, program);
    return program;
  } catch (const cl::BuildError& error) {
    std::string log;
    for (const auto& [where, text] : error.getBuildLog()) log += text;
    throw DeviceError(what + ": " + error_name(error.err()) +
                          "; is the kernel cache directory (POCL_CACHE_DIR) writable, and has it room?",
                      log);
  } catch (const cl::Error& error) {
    throw_device_error(what, error);
  }
}

cl::Program build_program(const Device& device, std::initializer_list<std::string_view> files, Precision precision,
                          const std::string& options) {
  std::vector<KernelText> parts;
  for (const auto file : files) parts.push_back({std::string(file)});
  return build_program(device, parts, precision, options);
}

cl::Kernel make_kernel(const cl::Program& program, const char* name, unsigned arguments) {
  return checked(std::string("kernel ") + name, [&] {
    cl::Kernel kernel(program, name);
    const auto count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    if (count != arguments) {
      throw DeviceError(std::string("kernel ") + name + " takes " + std::to_string(count) + " arguments; expected " +
                        std::to_string(arguments));
    }
    return kernel;
  });
}

}  // namespace lobe
