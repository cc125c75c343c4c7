#include "math/instructions.h"

namespace tress {

bool available(Instructions set) {
  if (set == Instructions::base) return true;
#if TRESS_HAS_AVX512
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

Instructions widest_instructions() {
  static const Instructions set =
      available(Instructions::avx512) ? Instructions::avx512 : Instructions::base;
  return set;
}

const char* name(Instructions set) {
  if (set == Instructions::avx512) return "avx512";
#if defined(__AVX512F__)
  return "avx512";
#elif defined(__AVX2__)
  return "avx2";
#elif defined(__AVX__)
  return "avx";
#else
  return "plain";
#endif
}

}  // namespace tress
