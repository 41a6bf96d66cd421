// A library that is preloaded before the OpenCL loader and does with chosen calls what broken drivers do. By variables
// of the environment:
//
//   LOBE_CL_FAIL=NAME:N[+][:CODE]   the N-th call of the entry point NAME (from 1; of any where NAME is *) is not made
//                                   and answered by the error CODE (CL_OUT_OF_RESOURCES, -5, by default); with a + all
//                                   calls from the N-th on
//   LOBE_CL_LOG=FILE                a line with the entry point's name is appended for every call
//   LOBE_CL_KERNELS=FILE            a line with its name is appended for every kernel that is launched the first time
//   LOBE_CL_PERTURB=RELATIVE        what comes back from the device is wrong: of every buffer that is read, or mapped
//                                   to be read, the value that is largest is multiplied by 1 + RELATIVE
//   LOBE_CL_PERTURB_VALUES=all      all values are
//   LOBE_CL_PERTURB_TYPE=float      they are taken for floats, not doubles
//   LOBE_CL_PERTURB_SOURCE=TEXT     only of buffers that are arguments of a kernel of a program whose source or build
//                                   options contain TEXT
//   LOBE_CL_PERTURB_FROM=N          only from the N-th of them on: behind the library's own tests of its kernels
//   LOBE_CL_PERTURB_LOG=FILE        a line "NAME BYTES" is appended for every buffer that was perturbed
//
// tests/nets/check_shim.sh holds the list of entry points against those that lobe calls.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <CL/cl.h>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace {

void append(const char* path, const std::string& line) {
  const int descriptor = ::open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0 || ::write(descriptor, line.data(), line.size()) < 0) std::abort();
  ::close(descriptor);
}

[[noreturn]] void refuse(const char* variable, const char* value) {
  std::fprintf(stderr, "opencl_shim: cannot understand %s=%s\n", variable, value);
  std::abort();
}

struct Fault {
  std::string name;
  long call = 0;
  bool lasts = false;
  cl_int code = CL_OUT_OF_RESOURCES;
};

Fault fault_of(const char* text) {
  Fault fault;
  if (text == nullptr) return fault;
  const std::string_view all = text;
  const std::size_t colon = all.find(':');
  if (colon == all.npos) refuse("LOBE_CL_FAIL", text);
  fault.name = all.substr(0, colon);
  char* end = nullptr;
  fault.call = std::strtol(text + colon + 1, &end, 10);
  if (*end == '+') {
    fault.lasts = true;
    ++end;
  }
  if (*end == ':') fault.code = static_cast<cl_int>(std::strtol(end + 1, &end, 10));
  if (*end != '\0' || fault.call < 1 || fault.code >= 0) refuse("LOBE_CL_FAIL", text);
  return fault;
}

/// Programs, kernels and buffers, and whether what they hold is to be perturbed.
class Shim {
 public:
  static Shim& get() {
    static auto& one = *new Shim;  // never destroyed: calls may come as late as they like
    return one;
  }

  /// \return the error that answers this call, or CL_SUCCESS where it is to be made
  cl_int note(const char* name) {
    const std::lock_guard lock(mutex_);
    if (log_ != nullptr) append(log_, std::string(name) + "\n");
    const long call = ++calls_[name];
    const long any = ++all_calls_;
    if (fault_.call == 0 || (fault_.name != "*" && fault_.name != name)) return CL_SUCCESS;
    const long now = fault_.name == "*" ? any : call;
    return now == fault_.call || (fault_.lasts && now > fault_.call) ? fault_.code : CL_SUCCESS;
  }

  [[nodiscard]] bool perturbs() const { return relative_ != 0; }

  void note_source(cl_program program, cl_uint count, const char** strings, const std::size_t* lengths) {
    std::string text;
    for (cl_uint i = 0; i < count; ++i) {
      text += lengths == nullptr || lengths[i] == 0 ? std::string(strings[i]) : std::string(strings[i], lengths[i]);
    }
    const std::lock_guard lock(mutex_);
    programs_.erase(program);  // an address that was another one's
    if (text.find(source_) != text.npos) programs_.insert(program);
  }
  void note_options(cl_program program, const char* options) {
    const std::lock_guard lock(mutex_);
    if (options != nullptr && std::string_view(options).find(source_) != std::string_view::npos) {
      programs_.insert(program);
    }
  }
  void note_kernel(cl_program program, cl_kernel kernel) {
    const std::lock_guard lock(mutex_);
    arguments_[kernel].clear();
    kernels_.erase(kernel);
    if (programs_.contains(program)) kernels_.insert(kernel);
  }
  void note_buffer(cl_mem buffer) {
    const std::lock_guard lock(mutex_);
    buffers_.erase(buffer);
  }
  void note_argument(cl_kernel kernel, cl_uint index, std::size_t size, const void* value) {
    const std::lock_guard lock(mutex_);
    arguments_[kernel].erase(index);
    if (size == sizeof(cl_mem) && value != nullptr) std::memcpy(&arguments_[kernel][index], value, size);
  }
  void note_launch(cl_kernel kernel, const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (kernels_log_ != nullptr && launched_.insert(name).second) append(kernels_log_, name + "\n");
    if (!kernels_.contains(kernel)) return;
    for (const auto& [index, buffer] : arguments_[kernel]) buffers_.insert(buffer);
  }

  void perturb(const char* name, cl_mem buffer, void* bytes, std::size_t size) {
    const std::lock_guard lock(mutex_);
    if (!source_.empty() && !buffers_.contains(buffer)) return;
    if (++seen_ < first_) return;
    const bool has_changed =
        is_float_ ? change<float>(bytes, size / sizeof(float)) : change<double>(bytes, size / sizeof(double));
    if (has_changed && perturb_log_ != nullptr)
      append(perturb_log_, std::string(name) + " " + std::to_string(size) + "\n");
  }

 private:
  Shim() {
    const char* relative = std::getenv("LOBE_CL_PERTURB");
    if (relative == nullptr) return;
    char* end = nullptr;
    relative_ = std::strtod(relative, &end);
    if (*relative == '\0' || *end != '\0') refuse("LOBE_CL_PERTURB", relative);
  }

  static std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
  }

  template <typename Value>
  bool change(void* bytes, std::size_t count) const {
    auto* values = static_cast<Value*>(bytes);
    const auto factor = static_cast<Value>(1 + relative_);
    std::size_t largest = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(values[i]) || values[i] == 0) continue;
      if (all_values_) values[i] *= factor;
      if (largest == count || std::abs(values[i]) > std::abs(values[largest])) largest = i;
    }
    if (!all_values_ && largest < count) values[largest] *= factor;
    return largest < count;
  }

  std::mutex mutex_;
  const Fault fault_ = fault_of(std::getenv("LOBE_CL_FAIL"));
  const char* const log_ = std::getenv("LOBE_CL_LOG");
  const char* const kernels_log_ = std::getenv("LOBE_CL_KERNELS");
  const char* const perturb_log_ = std::getenv("LOBE_CL_PERTURB_LOG");
  const std::string source_ = variable("LOBE_CL_PERTURB_SOURCE");
  const bool all_values_ = variable("LOBE_CL_PERTURB_VALUES") == "all";
  const bool is_float_ = variable("LOBE_CL_PERTURB_TYPE") == "float";
  const long first_ = std::strtol(variable("LOBE_CL_PERTURB_FROM").c_str(), nullptr, 10);
  long seen_ = 0;
  double relative_ = 0;
  long all_calls_ = 0;
  std::map<std::string, long> calls_;
  std::set<std::string> launched_;
  std::set<cl_program> programs_;
  std::set<cl_kernel> kernels_;
  std::set<cl_mem> buffers_;
  std::map<cl_kernel, std::map<cl_uint, cl_mem>> arguments_;
};

/// The entry point behind this library.
template <typename Function>
Function next(const char* name) {
  void* const found = ::dlsym(RTLD_NEXT, name);
  if (found == nullptr) {
    std::fprintf(stderr, "opencl_shim: no %s behind this library\n", name);
    std::abort();
  }
  return reinterpret_cast<Function>(found);
}

std::string name_of(cl_kernel kernel) {
  static const auto get_info = next<decltype(&clGetKernelInfo)>("clGetKernelInfo");
  std::size_t size = 0;
  if (get_info(kernel, CL_KERNEL_FUNCTION_NAME, 0, nullptr, &size) != CL_SUCCESS || size == 0) return "?";
  std::string name(size, '\0');
  get_info(kernel, CL_KERNEL_FUNCTION_NAME, size, name.data(), nullptr);
  name.pop_back();  // the zero at the end
  return name;
}

}  // namespace

#define LOBE_NEXT(name) static const auto next_call = next<decltype(&name)>(#name)

/// An entry point whose error is what it returns.
#define LOBE_PASS(name, parameters, arguments)           \
  cl_int name parameters {                               \
    LOBE_NEXT(name);                                     \
    const cl_int failure = Shim::get().note(#name);      \
    return failure != 0 ? failure : next_call arguments; \
  }

/// One that returns an object or a pointer, or none and an error in `code`.
#define LOBE_FAIL_OR(name)                                            \
  LOBE_NEXT(name);                                                    \
  if (const cl_int failure = Shim::get().note(#name); failure != 0) { \
    if (code != nullptr) *code = failure;                             \
    return nullptr;                                                   \
  }

using Events = const cl_event*;

extern "C" {

LOBE_PASS(clGetPlatformIDs, (cl_uint room, cl_platform_id* found, cl_uint* count), (room, found, count))
LOBE_PASS(clGetPlatformInfo,
          (cl_platform_id platform, cl_platform_info what, std::size_t room, void* value, std::size_t* size),
          (platform, what, room, value, size))
LOBE_PASS(clGetDeviceIDs,
          (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id* found, cl_uint* count),
          (platform, type, room, found, count))
LOBE_PASS(clGetDeviceInfo, (cl_device_id device, cl_device_info what, std::size_t room, void* value, std::size_t* size),
          (device, what, room, value, size))
LOBE_PASS(clRetainDevice, (cl_device_id device), (device))
LOBE_PASS(clReleaseDevice, (cl_device_id device), (device))
LOBE_PASS(clReleaseContext, (cl_context context), (context))
LOBE_PASS(clReleaseCommandQueue, (cl_command_queue queue), (queue))
LOBE_PASS(clRetainMemObject, (cl_mem buffer), (buffer))
LOBE_PASS(clReleaseMemObject, (cl_mem buffer), (buffer))
LOBE_PASS(clGetMemObjectInfo, (cl_mem buffer, cl_mem_info what, std::size_t room, void* value, std::size_t* size),
          (buffer, what, room, value, size))
LOBE_PASS(clRetainProgram, (cl_program program), (program))
LOBE_PASS(clReleaseProgram, (cl_program program), (program))
LOBE_PASS(clGetProgramInfo,
          (cl_program program, cl_program_info what, std::size_t room, void* value, std::size_t* size),
          (program, what, room, value, size))
LOBE_PASS(clGetProgramBuildInfo,
          (cl_program program, cl_device_id device, cl_program_build_info what, std::size_t room, void* value,
           std::size_t* size),
          (program, device, what, room, value, size))
LOBE_PASS(clRetainKernel, (cl_kernel kernel), (kernel))
LOBE_PASS(clReleaseKernel, (cl_kernel kernel), (kernel))
LOBE_PASS(clGetKernelInfo, (cl_kernel kernel, cl_kernel_info what, std::size_t room, void* value, std::size_t* size),
          (kernel, what, room, value, size))
LOBE_PASS(clGetKernelWorkGroupInfo,
          (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, std::size_t room, void* value,
           std::size_t* size),
          (kernel, device, what, room, value, size))
LOBE_PASS(clWaitForEvents, (cl_uint count, Events events), (count, events))
LOBE_PASS(clReleaseEvent, (cl_event event), (event))
LOBE_PASS(clFlush, (cl_command_queue queue), (queue))
LOBE_PASS(clFinish, (cl_command_queue queue), (queue))
LOBE_PASS(clEnqueueUnmapMemObject,
          (cl_command_queue queue, cl_mem buffer, void* mapped, cl_uint count, Events events, cl_event* event),
          (queue, buffer, mapped, count, events, event))
LOBE_PASS(clEnqueueWriteBuffer,
          (cl_command_queue queue, cl_mem buffer, cl_bool blocks, std::size_t offset, std::size_t size,
           const void* bytes, cl_uint count, Events events, cl_event* event),
          (queue, buffer, blocks, offset, size, bytes, count, events, event))

cl_context clCreateContext(const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
                           void(CL_CALLBACK* notify)(const char*, const void*, std::size_t, void*), void* data,
                           cl_int* code) {
  LOBE_FAIL_OR(clCreateContext)
  return next_call(properties, count, devices, notify, data, code);
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties properties,
                                      cl_int* code) {
  LOBE_FAIL_OR(clCreateCommandQueue)
  return next_call(context, device, properties, code);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t size, void* bytes, cl_int* code) {
  LOBE_FAIL_OR(clCreateBuffer)
  const cl_mem buffer = next_call(context, flags, size, bytes, code);
  Shim::get().note_buffer(buffer);
  return buffer;
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                     const std::size_t* lengths, cl_int* code) {
  LOBE_FAIL_OR(clCreateProgramWithSource)
  const cl_program program = next_call(context, count, strings, lengths, code);
  Shim::get().note_source(program, count, strings, lengths);
  return program;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                      void(CL_CALLBACK* notify)(cl_program, void*), void* data) {
  LOBE_NEXT(clBuildProgram);
  if (const cl_int failure = Shim::get().note("clBuildProgram"); failure != 0) return failure;
  Shim::get().note_options(program, options);
  return next_call(program, count, devices, options, notify, data);
}

cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* code) {
  LOBE_FAIL_OR(clCreateKernel)
  const cl_kernel kernel = next_call(program, name, code);
  Shim::get().note_kernel(program, kernel);
  return kernel;
}

cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, std::size_t size, const void* value) {
  LOBE_NEXT(clSetKernelArg);
  if (const cl_int failure = Shim::get().note("clSetKernelArg"); failure != 0) return failure;
  Shim::get().note_argument(kernel, index, size, value);
  return next_call(kernel, index, size, value);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const std::size_t* offset,
                              const std::size_t* global, const std::size_t* local, cl_uint count, Events events,
                              cl_event* event) {
  LOBE_NEXT(clEnqueueNDRangeKernel);
  if (const cl_int failure = Shim::get().note("clEnqueueNDRangeKernel"); failure != 0) return failure;
  Shim::get().note_launch(kernel, name_of(kernel));
  return next_call(queue, kernel, dimensions, offset, global, local, count, events, event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocks, std::size_t offset, std::size_t size,
                           void* bytes, cl_uint count, Events events, cl_event* event) {
  LOBE_NEXT(clEnqueueReadBuffer);
  auto& shim = Shim::get();
  if (const cl_int failure = shim.note("clEnqueueReadBuffer"); failure != 0) return failure;
  const cl_int status =
      next_call(queue, buffer, shim.perturbs() ? CL_TRUE : blocks, offset, size, bytes, count, events, event);
  if (shim.perturbs() && status == CL_SUCCESS) shim.perturb("clEnqueueReadBuffer", buffer, bytes, size);
  return status;
}

cl_int clEnqueueReadBufferRect(cl_command_queue queue, cl_mem buffer, cl_bool blocks, const std::size_t* buffer_origin,
                               const std::size_t* host_origin, const std::size_t* region, std::size_t buffer_row,
                               std::size_t buffer_slice, std::size_t host_row, std::size_t host_slice, void* bytes,
                               cl_uint count, Events events, cl_event* event) {
  LOBE_NEXT(clEnqueueReadBufferRect);
  auto& shim = Shim::get();
  if (const cl_int failure = shim.note("clEnqueueReadBufferRect"); failure != 0) return failure;
  const cl_int status = next_call(queue, buffer, shim.perturbs() ? CL_TRUE : blocks, buffer_origin, host_origin, region,
                                  buffer_row, buffer_slice, host_row, host_slice, bytes, count, events, event);
  // The first row of what was asked for.
  if (shim.perturbs() && status == CL_SUCCESS) {
    const std::size_t row = host_row != 0 ? host_row : region[0];
    const std::size_t slice = host_slice != 0 ? host_slice : region[1] * row;
    char* const first = static_cast<char*>(bytes) + host_origin[0] + host_origin[1] * row + host_origin[2] * slice;
    shim.perturb("clEnqueueReadBufferRect", buffer, first, region[0]);
  }
  return status;
}

void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocks, cl_map_flags flags, std::size_t offset,
                         std::size_t size, cl_uint count, Events events, cl_event* event, cl_int* code) {
  LOBE_FAIL_OR(clEnqueueMapBuffer)
  auto& shim = Shim::get();
  const bool changes = shim.perturbs() && (flags & CL_MAP_READ) != 0;
  void* const mapped =
      next_call(queue, buffer, changes ? CL_TRUE : blocks, flags, offset, size, count, events, event, code);
  if (changes && mapped != nullptr) shim.perturb("clEnqueueMapBuffer", buffer, mapped, size);
  return mapped;
}

}  // extern "C"
