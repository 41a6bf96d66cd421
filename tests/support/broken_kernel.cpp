// Planted bugs in kernels that ordinary runtimes do not notice and the instrumented one must.
// usage: lobe_broken_kernel write|race|uninitialised
//   write          writes one element past the end of a buffer
//   race           all items of a group write to one element
//   uninitialised  what is computed depends on memory that nobody has written
#include <CL/opencl.hpp>
#include <cstdio>
#include <string>
#include <vector>

int main(int count, char** words) {
  const std::string bug = count > 1 ? words[1] : "write";
  const char* source =
      "__kernel void beyond(__global double* out, __global const double* in, const uint size) {\n"
      "  const uint i = (uint)get_global_id(0);\n"
      "  if (i <= size) out[i] = 1.0;\n"
      "}\n"
      "__kernel void together(__global double* out, __global const double* in, const uint size) {\n"
      "  out[0] = (double)get_global_id(0);\n"
      "}\n"
      "__kernel void unwritten(__global double* out, __global const double* in, const uint size) {\n"
      "  const uint i = (uint)get_global_id(0);\n"
      "  if (i < size) out[i] = in[i] > 0.5 ? 2.0 : 3.0;\n"
      "}\n";
  std::vector<cl::Platform> platforms;
  cl::Platform::get(&platforms);
  std::vector<cl::Device> devices;
  platforms.at(0).getDevices(CL_DEVICE_TYPE_ALL, &devices);
  const cl::Device& device = devices.at(0);
  const cl::Context context(device);
  cl::CommandQueue queue(context, device);
  cl::Program program(context, source);
  program.build(device, "-cl-std=CL1.2");
  cl::Kernel kernel(program, bug == "race" ? "together" : bug == "uninitialised" ? "unwritten" : "beyond");
  constexpr cl_uint kSize = 7;
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE, kSize * sizeof(double));
  const cl::Buffer unwritten(context, CL_MEM_READ_WRITE, kSize * sizeof(double));
  kernel.setArg(0, buffer);
  kernel.setArg(1, unwritten);
  kernel.setArg(2, kSize);
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(8));
  std::vector<double> out(kSize);
  queue.enqueueReadBuffer(buffer, CL_TRUE, 0, kSize * sizeof(double), out.data());
  std::printf("%g\n", out[0]);
  return 0;
}
