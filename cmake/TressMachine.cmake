# TRESS_MARCH: the instructions that a Release build may use. A build for x86-64-v3 (AVX2
# and fused products, of 2013) gives the same bits on all machines that have them, and uses
# wider registers where they are (math/instructions.h).
set(TRESS_MARCH "" CACHE STRING "-march of a Release build; auto: x86-64-v3 if it runs here")
set(tress_march ${TRESS_MARCH})
if(TRESS_MARCH STREQUAL auto)
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("
    int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }"
    TRESS_RUNS_X86_64_V3)
  if(TRESS_RUNS_X86_64_V3)
    set(tress_march x86-64-v3)
  else()
    set(tress_march native)
  endif()
endif()
if(tress_march)
  string(APPEND CMAKE_CXX_FLAGS_RELEASE " -march=${tress_march}")
endif()
