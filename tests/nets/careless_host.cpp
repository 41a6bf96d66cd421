// A planted fault: a program that looks at no error of OpenCL. It prints 12.
#include <CL/cl.h>
#include <array>
#include <cstdio>

int main() {
  const char* source =
      "__kernel void sum(__global double* out, const uint size) {\n"
      "  double all = 0;\n"
      "  for (uint i = 0; i < size; ++i) all += 3;\n"
      "  out[0] = all;\n"
      "}\n";
  cl_platform_id platform = nullptr;
  clGetPlatformIDs(1, &platform, nullptr);
  cl_device_id device = nullptr;
  clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr);
  cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
  cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);
  cl_program program = clCreateProgramWithSource(context, 1, &source, nullptr, nullptr);
  clBuildProgram(program, 1, &device, "-cl-std=CL1.2", nullptr, nullptr);
  cl_kernel kernel = clCreateKernel(program, "sum", nullptr);
  cl_mem buffer = clCreateBuffer(context, CL_MEM_READ_WRITE, sizeof(double), nullptr, nullptr);
  const cl_uint size = 4;
  clSetKernelArg(kernel, 0, sizeof(cl_mem), &buffer);
  clSetKernelArg(kernel, 1, sizeof(cl_uint), &size);
  const std::size_t one = 1;
  clEnqueueNDRangeKernel(queue, kernel, 1, nullptr, &one, nullptr, 0, nullptr, nullptr);
  double result = 0;
  clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, sizeof result, &result, 0, nullptr, nullptr);
  std::printf("%g\n", result);
  return 0;
}
