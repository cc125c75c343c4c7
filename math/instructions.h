#pragma once

namespace tress {

/// Inlines into a kernel all functions that it calls. Not with sanitizers that check
/// every access: with the checks inlined as well, a kernel takes minutes to compile.
#ifdef __SANITIZE_ADDRESS__
#define TRESS_FLATTEN
#else
#define TRESS_FLATTEN [[gnu::flatten]]
#endif

/// Sets of vector instructions. A program is compiled for the first, `base`, which it
/// needs to run at all; kernels use another set, `avx512`, where the machine has that
/// set.
enum class Instructions { base, avx512 };

/// Whether this machine and this program have them.
bool available(Instructions set);
/// The last of those available.
Instructions widest_instructions();
/// "avx512" and so on; of `base` what the compiler was allowed, such as "avx2".
const char* name(Instructions set);

// TRESS_ONE_PACK, from the build: kernels exist for packs of four doubles only, since
// their instances take time to compile.
// Without fused products in the base, bits would depend on the machine. Clang inlines
// less than is asked for, and then passes packs in registers that a callee does not look
// at.
#if defined(__x86_64__) && defined(__FMA__) && defined(__GNUC__) && \
    !defined(__clang__) && !defined(TRESS_ONE_PACK)
#define TRESS_HAS_AVX512 1
#else
#define TRESS_HAS_AVX512 0
#endif

#if TRESS_HAS_AVX512
template <class Work>
[[gnu::target("avx512f,avx512dq,avx512bw,avx512vl"), gnu::flatten]] void by_avx512(
    const Work& work) {
  work();
}
#endif

/// Does work() by instructions that are available, with the same bits. What work() calls
/// is inlined; what cannot be must neither take nor return packs, which are passed
/// differently there (LaneFunctions::longer).
template <class Work>
void by(Instructions set, const Work& work) {
#if TRESS_HAS_AVX512
  if (set == Instructions::avx512) return by_avx512(work);
#else
  static_cast<void>(set);
#endif
  work();
}

/// Does work() on packs T by the instructions of their registers: packs of 512 bits by
/// the widest that are available, shorter ones by the base. With more sets for shorter
/// packs, kernels would take half as long again to compile.
template <class T, class Work>
void by_registers_of(const Work& work) {
  if constexpr (sizeof(T) == 64) {
    by(widest_instructions(), work);
  } else {
    work();
  }
}

}  // namespace tress
