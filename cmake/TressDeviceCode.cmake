# Device code: clang alone turns a .cu source into PTX (PTX ISA), which the driver of a GPU
# compiles when a program loads it. Without clang programs are built without it, and say so.
find_program(TRESS_DEVICE_CLANG NAMES clang++-14 clang++ clang++-19 clang++-18 clang++-17
             clang++-16 clang++-15 DOC "clang that makes device code")
set(TRESS_DEVICE_ARCH sm_80 CACHE STRING "Oldest GPU that device code is made for")
# The standard library is the host's; CUDA's headers and libraries are not looked at.
set(tress_device_options -x cuda --cuda-device-only --cuda-gpu-arch=${TRESS_DEVICE_ARCH}
    --cuda-path=/nowhere -nocudainc -nocudalib -std=c++20 -O3 -fno-math-errno -S)
if(TRESS_DEVICE_CLANG AND NOT DEFINED TRESS_HAS_DEVICE_CODE)
  file(WRITE ${CMAKE_BINARY_DIR}/device_check.cu
       "#include <array>\n__attribute__((global)) void nothing() {}\n")
  execute_process(COMMAND ${TRESS_DEVICE_CLANG} ${tress_device_options}
                          ${CMAKE_BINARY_DIR}/device_check.cu -o /dev/null
                  RESULT_VARIABLE refused OUTPUT_QUIET ERROR_QUIET)
  if(refused EQUAL 0)
    set(TRESS_HAS_DEVICE_CODE ON CACHE INTERNAL "clang makes device code")
  else()
    set(TRESS_HAS_DEVICE_CODE OFF CACHE INTERNAL "clang makes no device code")
  endif()
endif()
if(NOT TRESS_HAS_DEVICE_CODE)
  message(STATUS "No clang++ that makes device code (Debian: clang-14): programs run "
                 "without GPUs")
endif()

# tress_device_code(name source result): result is a C++ source that defines
# tress::models::<name>, the PTX of the source or "".
function(tress_device_code name source result)
  set(ptx ${CMAKE_CURRENT_BINARY_DIR}/${name}.ptx)
  set(made ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  set(embed ${CMAKE_COMMAND} -Dname=${name} -Dptx=${ptx} -Dmade=${made} -P
      ${PROJECT_SOURCE_DIR}/cmake/embed_device_code.cmake)
  if(TRESS_HAS_DEVICE_CODE)
    add_custom_command(OUTPUT ${made}
      COMMAND ${TRESS_DEVICE_CLANG} ${tress_device_options} -I${PROJECT_SOURCE_DIR}
              -MD -MF ${ptx}.d -MT ${made} ${CMAKE_CURRENT_SOURCE_DIR}/${source} -o ${ptx}
      COMMAND ${embed}
      DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/embed_device_code.cmake
      DEPFILE ${ptx}.d COMMENT "Device code ${name}" VERBATIM)
  else()
    add_custom_command(OUTPUT ${made} COMMAND ${embed} VERBATIM)
  endif()
  set(${result} ${made} PARENT_SCOPE)
endfunction()
