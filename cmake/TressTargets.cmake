# Warnings for our own targets, and one function per kind of target.
function(tress_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion)
  # In a batch what one source keeps to itself would be in the way of the next one's words;
  # GCC can look at local ones alone.
  get_target_property(batched ${target} UNITY_BUILD)
  if(NOT batched)
    target_compile_options(${target} PRIVATE -Wshadow)
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wshadow=local)
  endif()
  # Packs of doubles are passed in another way where there is no AVX; nothing here leaves
  # the library as a binary.
  target_compile_options(${target} PRIVATE -Wno-psabi)
  # GCC 12 sees uninitialised variables inside its own AVX-512 intrinsics (GCC bug 105593).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-uninitialized
      -Wno-maybe-uninitialized)
  endif()
  # Its garbage collector, left to itself, takes a tenth of the time of a build.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE "SHELL:--param ggc-min-heapsize=1000000")
  endif()
  if(TRESS_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# tress_headers(name header...): an object library that compiles these headers of others once
# for the targets that reuse them, a third of the time of a build. Their options must be the
# same as this one's; sources still include what they use.
function(tress_headers name)
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "// carries precompiled headers\n")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <functional> <limits>
    <memory> <numbers> <numeric> <optional> <span> <string> <string_view> <vector> ${ARGN})
  tress_warnings(${name})
endfunction()

function(tress_optimise_less target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Eight sources as one take half of the compiler's time of eight.
function(tress_in_batches target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TRESS_BATCHES}
                        UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# tress_library(name [BATCHES] source... [ALONE source...]): tress_<name>, also known as
# tress::<name>. ALONE: in no batch, so that a change of one is compiled soon and a new one
# leaves the batches as they are. Link Eigen as $<BUILD_INTERFACE:Eigen3::Eigen>: users of the
# installed library do not need it.
function(tress_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "BATCHES" "" "ALONE")
  add_library(tress_${name} STATIC ${arg_UNPARSED_ARGUMENTS} ${arg_ALONE})
  if(arg_ALONE)
    set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  if(arg_BATCHES)
    tress_in_batches(tress_${name})
  endif()
  add_library(tress::${name} ALIAS tress_${name})
  set_target_properties(tress_${name} PROPERTIES EXPORT_NAME ${name}
                        POSITION_INDEPENDENT_CODE ON)
  if(NOT TARGET tress_library_headers)
    tress_headers(tress_library_headers <Eigen/Dense>)
    set_target_properties(tress_library_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(tress_library_headers PRIVATE Eigen3::Eigen)
  endif()
  target_precompile_headers(tress_${name} REUSE_FROM tress_library_headers)
  target_compile_features(tress_${name} PUBLIC cxx_std_20)
  target_include_directories(tress_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/tress>)
  tress_warnings(tress_${name})
endfunction()

# tress_kernel(source... [FUSED] [LARGE]): sources of the target of this folder whose results
# are the same bits for any number of lanes. Products are not fused with sums: which of them
# are would depend on the number of lanes. Square roots of packs are one instruction, as they
# need not set errno. FUSED: products may be fused; tests alone say that bits are the same.
# LARGE: in functions as long as these GCC looks for what it has loaded already for a fifth to
# a third of its time, and they are no faster for it.
function(tress_kernel)
  cmake_parse_arguments(PARSE_ARGV 0 arg "FUSED;LARGE" "" "")
  set(options -fno-math-errno)
  if(NOT arg_FUSED)
    list(APPEND options -ffp-contract=off)
  endif()
  if(arg_LARGE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND options -fno-gcse -fno-gcse-after-reload)
  endif()
  set_source_files_properties(${arg_UNPARSED_ARGUMENTS} PROPERTIES
    COMPILE_OPTIONS "${options}" SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# tress_program(target): what experiments are made of. Models and integrators do the work
# and are optimised; programs and tests are not as much, which costs more than it brings.
# All of it can be linked into the Python module, and precompiled headers want the same
# option everywhere.
function(tress_program target)
  if(NOT TARGET tress_program_headers)
    tress_headers(tress_program_headers <Eigen/Dense> <chrono> <filesystem> <fmt/format.h>
                  <map> <nlohmann/json.hpp> <set> <stdexcept>)
    target_link_libraries(tress_program_headers PRIVATE Eigen3::Eigen fmt::fmt
                          nlohmann_json::nlohmann_json Threads::Threads)
    target_compile_options(tress_program_headers PRIVATE -fPIC)
    tress_optimise_less(tress_program_headers)
  endif()
  target_precompile_headers(${target} REUSE_FROM tress_program_headers)
  target_compile_options(${target} PRIVATE -fPIC)
  tress_optimise_less(${target})
  tress_warnings(${target})
endfunction()

# tress_test(name source... [SHARDS n] [MORE n]): an executable of GoogleTest cases, of which
# ctest runs name_0, name_1, ... n parts: of cases that take milliseconds, one process each is
# all start-up. MORE: suites that are instantiated as More repeat others on a larger population;
# name_more_0, ... of label `long` run them, in n parts.
function(tress_test name)
  if(NOT TARGET tress_test_headers)
    tress_headers(tress_test_headers <gmock/gmock.h> <gtest/gtest.h> <Eigen/Dense> <random>
                  <sstream>)
    target_link_libraries(tress_test_headers PRIVATE GTest::gtest GTest::gmock Eigen3::Eigen)
    tress_optimise_less(tress_test_headers)
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SHARDS;MORE" "")
  add_executable(test_${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(test_${name} PRIVATE tress_numerics tress::integrators tress::models
                        GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(test_${name} PRIVATE
                             TRESS_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             TRESS_BINARY_DIR="${PROJECT_BINARY_DIR}")
  tress_optimise_less(test_${name})
  target_precompile_headers(test_${name} REUSE_FROM tress_test_headers)
  tress_in_batches(test_${name})
  tress_warnings(test_${name})
  if(NOT arg_SHARDS)
    set(arg_SHARDS 1)
  endif()
  tress_test_parts(${name} "" "-More/*" ${arg_SHARDS})
  set(${name}_shards ${shards} PARENT_SCOPE)    # names of the tests
  set(${name}_reports ${reports} PARENT_SCOPE)  # what each of them writes
  if(arg_MORE)
    tress_test_parts(${name} _more "More/*" ${arg_MORE})
    set_tests_properties(${shards} PROPERTIES LABELS long)
  endif()
  foreach(source IN LISTS arg_UNPARSED_ARGUMENTS)
    file(STRINGS ${source} found REGEX "^ *(INSTANTIATE_TEST_SUITE_P.)?More,")
    if(found AND NOT arg_MORE)
      message(FATAL_ERROR "test_${name} has suites of the name More: give it MORE")
    endif()
  endforeach()
endfunction()

# The cases of an executable that a filter lets through, in n parts; their names in `shards`,
# their reports in `reports`.
function(tress_test_parts name suffix filter n)
  set(shards)
  set(reports)
  math(EXPR last "${n} - 1")
  foreach(part RANGE ${last})
    set(test ${name}${suffix}_${part})
    set(report ${CMAKE_CURRENT_BINARY_DIR}/${test}.xml)
    add_test(NAME ${test}
             COMMAND test_${name} --gtest_brief=1 --gtest_output=xml:${report})
    set_tests_properties(${test} PROPERTIES TIMEOUT 900 ENVIRONMENT
      "GTEST_FILTER=${filter};GTEST_TOTAL_SHARDS=${n};GTEST_SHARD_INDEX=${part}")
    list(APPEND shards ${test})
    list(APPEND reports ${report})
  endforeach()
  set(shards ${shards} PARENT_SCOPE)
  set(reports ${reports} PARENT_SCOPE)
endfunction()
