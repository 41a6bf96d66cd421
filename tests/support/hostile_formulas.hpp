#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobe::test {

inline std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  for (std::size_t k = 0; k < times; ++k) all += text;
  return all;
}

/// Formulas that try to reach the compiler, the processor, files or the memory of the process. Every one stands in a
/// material with the parameter `n`, and its value would do as a reflectance if it came through.
inline std::vector<std::string> hostile_formulas() {
  using namespace std::string_literals;
  std::vector<std::string> list{
      // Out of the expression and the function.
      "1.0); const pack y = (2.0", "1.0); return TO_REAL(pi); (1.0", "1.0);} real formula2() { return (1.0", "1.0; 2.0",
      "1.0 }", "1.0)", "(1.0", "1.0))", "1.0;", "}{", "{ 1.0 }", "1.0); for (;;); (1.0", "1.0); while (1); (1.0",
      "1.0); *(volatile int*)0 = 1; (1.0", "1.0); goto x; x: (1.0", "1.0); printf(\"x\"); (1.0",
      "1.0); barrier(CLK_LOCAL_MEM_FENCE); (1.0", "1.0); int a[1000000000]; (1.0", "1.0); __asm__(\"nop\"); (1.0",
      "1.0); } __kernel void k(__global double* x) { x[0] = 1; } real f2() { return (1.0", "1.0);\n#line 1 \"x\"\n(1.0",
      "1.0);\n#undef pack\n(1.0", "pi) + (pi);(pi", "1.0) ? (1.0) : (2.0",
      // Statement expressions.
      "({ 1.0; })", "({ while (1); 1.0; })", "({ int i = 0; i; }) + 1.0", "({ __asm__ volatile(\"nop\"); 1.0; })",
      "({ pack x = pi; x; })", "({ goto *0; 1.0; })", "({ for (int i = 0; i < 10; ++i); 1.0; })", "({})",
      "({ int* p = 0; *p; })", "({ return; 1.0; })",
      // Inline assembly.
      "__asm__(\"syscall\")", "asm(\"int3\")", "__asm volatile(\"hlt\")",
      "asm volatile (\"mov $60, %%rax; syscall\" ::: )", "__asm__ __volatile__ (\"\" : : : \"memory\") + 1.0",
      "asm goto (\"\")",
      // The preprocessor.
      "#include \"/etc/passwd\"\n1.0", "1.0\n#include \"/etc/passwd\"\n", "#include </etc/hostname>\n1.0",
      "1.0\n#define pi 3\n", "#pragma OPENCL EXTENSION all : enable\n1.0", "1.0\n#error x\n",
      "1.0\n#if 1\n+ 1.0\n#endif\n", "_Pragma(\"unroll\") 1.0", "__FILE__", "__LINE__", "__COUNTER__", "__DATE__",
      "__TIME__", "__INCLUDE_LEVEL__", "defined(pi)", "1.0 ## 2.0", "#pi", "__has_include(\"/etc/passwd\")",
      "__has_builtin(__builtin_trap)", "%:include \"/etc/passwd\"\n1.0", "?\?=include \"/etc/passwd\"\n1.0",
      "#embed \"/etc/passwd\"\n1.0", "__VA_ARGS__", "__OPENCL_VERSION__",
      // Trigraphs, digraphs, spliced lines, comments.
      "1.0 ?\?/\n + 2.0", "1.0 ?\?( 0 ?\?)", "<% 1.0 %>", "1.0 <: 0 :>", "?\?<1.0?\?>", "1.0 \\\n + 2.0", "1\\\n.0",
      "\\", "1.0 + \\u0070i", "1.0 /* comment */", "/* 1.0 */ 2.0", "1.0 // comment", "// 1.0\n2.0", "1.0 /* open",
      "/**/1.0", "1.0 /\\\n* x */", "pi ?\?- 1.0", "1.0 ?\?! 2.0", "%:%: 1.0",
      // Texts and characters.
      "\"text\"", "'c'", "\"text\"[0]", "*\"text\"", "L\"text\"", "1.0 + sizeof(\"x\")", "'\\0'", "u8\"x\"",
      "\"\\x00\"", "\"a\" \"b\"", "R\"(x)\"", "\"unclosed", "'unclosed",
      // Attributes, types, casts.
      "__attribute__((noreturn)) 1.0", "__attribute__((section(\"x\"))) 1.0", "(double)1.0", "(float)pi",
      "(float4)(1.0, 2.0, 3.0, 4.0)", "(pack)(1.0)", "(real)(1.0)", "(double8)(0)", "(int)1.0", "sizeof(int)",
      "sizeof pi", "vec_step(int)", "as_int(1.0f)", "as_long(pi)", "as_double(1UL)", "convert_int(pi)",
      "convert_double8(1.0)", "typeof(pi)(1.0)", "__typeof__(1.0) x", "_Alignof(int)", "_Generic(1.0, default: 1.0)",
      "(struct { int a; }){1}.a", "(union { double d; long l; }){1.0}.l", "(enum { A }) 0", "(int[]){1, 2}[0]",
      "__builtin_offsetof(geometry, cos_i)", "double", "(void)0", "const pack", "(size_t)1", "volatile 1.0",
      "(__global double*)0", "bool(1)",
      // Pointers and arrays.
      "*(int*)0", "*(__global double*)0", "*(volatile double*)16", "&pi", "*&pi", "&n", "pi[0]", "n[1000000000]",
      "0[&pi]", "*(pack*)&c", "(&g)->cos_i", "((double*)&c)[100]", "&&label", "*n", "**n", "pi->x",
      "(*(void(**)())0)()", "((double(*)(double))0)(1.0)", "&formula", "&__func__", "__func__[0]",
      "1.0 + *(__constant double*)1",
      // Assignments and other operators that change something.
      "n = 2.0", "pi = 3.0", "c.c0 = 1.0", "n += 1.0", "n *= 2.0", "n -= 1", "n /= 2", "n++", "++n + 0 * n++", "n--",
      "(n = 1.0)", "cos_i = cos_o", "g.cos_i = 1", "n <<= 1", "n |= 1", "n ^= 1", "n %= 2", "n &= 1",
      // The comma, choices of C, bits.
      "1.0, 2.0", "(1.0, 2.0)", "n ? 1.0 : 2.0", "cos_i > 0 ? 1.0 : 2.0", "n ?: 1.0", "1 << 70", "n >> 1", "n & 1",
      "n | 1", "n ^ 2", "~n", "n % 2", "n ** 2", "!n", "n && n", "cos_i > 0", "(cos_i > 0) * 2", "cos_i < cos_o < 1.0",
      "where(n, 1, 2)", "where(cos_i, 1.0, 2.0)", "where(cos_i > 0, cos_i > 0, 1)", "where(!n, 1, 2)", "!(cos_i > 0)",
      "cos_i > 0 || cos_o > 0", "-(cos_i > 0)", "exp(cos_i > 0)", "where((1.0, cos_i > 0), 1, 2)", "n <=> 1",
      // Words of the language.
      "while", "while (1)", "for (;;) 1.0", "if (1) 1.0", "do 1.0 while (1)", "return 1.0", "goto x", "switch (1) {}",
      "break", "int x", "struct geometry", "typedef int x", "__kernel", "kernel void f()", "extern int x", "static 1.0",
      "restrict", "__global", "__local double x[1]", "__constant", "inline", "register 1.0", "true", "false", "NULL",
      "nullptr", "this", "new double", "throw 1", "auto x", "[]{}()", "lambda", "operator", "template", "asm", "#",
      // Functions of OpenCL C and of the compiler that are no mathematics.
      "printf(\"x\")", "get_global_id(0)", "get_global_size(0) * 1.0", "get_local_id(0)", "get_group_id(0)",
      "get_work_dim()", "barrier(1)", "mem_fence(1)", "vload8(0, &pi)", "vload_half(0, 0)", "vstore8(pi, 0, 0)",
      "atomic_add(0, 1)", "atom_inc(0)", "async_work_group_copy(0, 0, 1, 0)", "wait_group_events(0, 0)",
      "prefetch(0, 1)", "shuffle(pi, 0)", "select(1.0, 2.0, 1)", "bitselect(1.0, 2.0, 3.0)", "any(cos_i > 0)",
      "all(cos_i > 0)", "read_imagef(0, 0)", "enqueue_kernel()", "nan(0)", "frexp(pi, &n)", "modf(pi, &n)",
      "sincos(pi, &n)", "fract(pi, &n)", "lgamma_r(pi, &n)", "remquo(1.0, 2.0, &n)", "ldexp(1.0, 1000)", "pown(pi, 3)",
      "rootn(pi, 3)", "abs(1)", "popcount(1)", "clz(1)", "mul24(1, 2)", "rotate(1, 2)", "upsample(1, 2)", "length(pi)",
      "cross(pi, pi)", "__builtin_trap()", "__builtin_unreachable()", "__builtin_alloca(1000000000)",
      "__builtin_return_address(0)", "__builtin_memcpy(0, 0, 100)", "__builtin_ia32_rdtsc()", "__builtin_assume(0)",
      "__builtin_expect(1, 2)", "system(\"id\")", "abort()", "exit(0)", "malloc(10)", "syscall(60)",
      "fopen(\"/etc/passwd\")", "execve(0, 0, 0)", "memcpy(0, 0, 1)", "half_exp(pi)", "native_exp(pi)", "formula(g, c)",
      "formula_fresnel(pi, pi, pi)",
      // Words of the kernels.
      "FORMULA_GEOMETRY", "FORMULA_TANGENTS", "FORMULA_PI", "FORMULA_FUNCTION(exp)", "TO_PACK(c.c0)", "TO_REAL(pi)",
      "REAL_C(1.0)", "SPLAT(1.0)", "LOAD_PACK(0, 0)", "STORE_PACK(pi, 0, 0)", "MODEL(g, c)", "BASE", "PUMPING(c, 1, 1)",
      "REAL_BITS", "REAL_WIDTH", "COEFFICIENTS", "LOBE_NUMBERS", "ROW_COS_I", "g", "c", "g.cos_i", "c.c0",
      "c.curves[0]", "g.slope_x", "pi.s0", "pi.x", "pi.lo", "n.s01234567", "value", "pack", "real", "geometry",
      "coefficients", "v0", "p1", "flag", "smooth_boundary", "schlick_fresnel(1, 1, 1)", "splat_coefficients(0)",
      // Numbers that are none, or too large.
      "0x1f", "0x1p3", "0X1.8p+1", "1.0f", "1.0F", "1f", "1.0h", "1u", "1UL", "1L", "1.0l", "1e", "1e+", "1.2.3",
      "1..2", ".", "1e999", "1e-999", repeated("9", 400), "0b101", "1'000", "1_000", "1.0e5.0", "inf + 1", "nan + 1",
      "INFINITY", "NAN", "HUGE_VAL", "MAXFLOAT", "M_PI", "1.0_r", "1i", "0x", "..1", "1e5x", "1e99999999999999999999",
      // Calls with other numbers of arguments, and names without.
      "exp()", "exp", "exp(1, 2)", "pow(1)", "pow(1, 2, 3)", "where()", "where(cos_i > 0, 1)", "where", "fresnel(1, 2)",
      "clamp(1, 2)", "atan2(1)", "exp(1,)", "exp(,1)", "pow(1,,2)", "n(1)", "pi(1)", "cos_i(1)", "exp(exp)", "(exp)(1)",
      "2(3)", "2 pi", "n n", "(1)(2)", "1 2",
      // Bytes that nobody types.
      "1.0\0 + 2.0"s, "\0"s, "1.0\x01", "1.0\x1b[2J",
      "\x1b]0;title\x07"
      "1.0",
      "1.0\x7f", "1.0\x80", "1.0\xff\xfe",
      "\xef\xbb\xbf"
      "1.0",
      "π", "1.0 × 2.0", "1.0 − 2.0", "１.0", "ｐｉ", "соs_i", "1.0\u00a0+ 2.0", "1.0\u200b", "1.0\u2028+ 2.0",
      "\u202e"
      "1.0",
      "1.0\v+ 2.0", "1.0\f+ 2.0", "1.0\b", "\xc3", "\xe2\x82", "\xf0\x9f\x98\x80", "\xc0\xaf", "\xed\xa0\x80",
      "1.0\u0085+ 2.0", "cos\u0301_i", "$", "@", "`id`", "$(id)", "$n", "@n", "n$", "n@", "1.0 `id`", "${n}", "%n",
      "%s%n",
      // Too much.
      repeated("(", 101) + "1.0" + repeated(")", 101), repeated("(", 100000), repeated(")", 1000),
      repeated("-", 101) + "1.0", repeated("exp(", 101) + "1" + repeated(")", 101), repeated("1+", 600) + "1",
      repeated("+", 9000) + "1", repeated("where(cos_i>0,", 60) + "1", "1" + repeated("*n", 5000), repeated("a", 65),
      repeated("a", 9999), repeated(" ", 10001) + "1.0", repeated("!", 200) + "(cos_i > 0)", repeated("[", 5000),
      repeated("{", 5000), repeated("exp(", 5000), repeated("a+", 20000) + "a", repeated("where(", 3000),
      repeated("1", 10001),
      // Nothing.
      "", " ", "\n", "\t\n ", "()", "+", "-", "*", "/", "+-", "1 +", "* 1", "1 *", "/ 1", "1 / * 2", "!", "&&",
      "==", "1 ==", "<", ",", "(,)", "((1)", "(1))"};
  return list;
}

}  // namespace lobe::test
