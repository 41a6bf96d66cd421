// A planted bug: writes one element past the end of a buffer. Ordinary runtimes do not notice; the instrumented one
// must.
#include <CL/opencl.hpp>
#include <cstdio>
#include <vector>

int main() {
  const char* source =
      "__kernel void fill(__global double* out, const uint size) {\n"
      "  const uint i = (uint)get_global_id(0);\n"
      "  if (i <= size) out[i] = 1.0;\n"
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
  cl::Kernel kernel(program, "fill");
  constexpr cl_uint kSize = 7;
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE, kSize * sizeof(double));
  kernel.setArg(0, buffer);
  kernel.setArg(1, kSize);
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(8));
  std::vector<double> out(kSize);
  queue.enqueueReadBuffer(buffer, CL_TRUE, 0, kSize * sizeof(double), out.data());
  std::printf("%g\n", out[0]);
  return 0;
}
