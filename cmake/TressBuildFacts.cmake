# What manifests record of this build: TRESS_BUILD_FACTS, definitions that change when it is
# configured, and generated/built_from.h with the commit, which each build looks up again.
find_package(Git QUIET)
set(tress_built_from ${PROJECT_BINARY_DIR}/generated/simulation/files/built_from.h)
set(tress_look_up_commit ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DROOT=${PROJECT_SOURCE_DIR}
    -DOUTPUT=${tress_built_from} -P ${PROJECT_SOURCE_DIR}/cmake/built_from.cmake)
# Always out of date; as the file is written only when it changes, so is what includes it.
add_custom_target(tress_built_from COMMAND ${tress_look_up_commit}
                  BYPRODUCTS ${tress_built_from} VERBATIM)
string(TOUPPER "${CMAKE_BUILD_TYPE}" tress_build_type)
set(tress_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${tress_build_type}}")
# A package records no folder of the machine that built it: its bits are the same elsewhere.
option(TRESS_RECORD_FOLDERS "Programs record the source tree, to warn where it has changed" ON)
set(tress_source_tree "")
if(TRESS_RECORD_FOLDERS)
  set(tress_source_tree ${PROJECT_SOURCE_DIR})
else()
  string(REGEX REPLACE "-f[a-z]+-prefix-map=[^ ]+" "" tress_flags "${tress_flags}")
endif()
string(REGEX REPLACE " +" " " tress_flags "${tress_flags}")
string(STRIP "${tress_flags}" tress_flags)
set(TRESS_BUILD_FACTS "TRESS_VERSION=\"${PROJECT_VERSION}\";\
TRESS_SOURCE_TREE=\"${tress_source_tree}\";\
TRESS_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\";\
TRESS_FLAGS=\"${tress_flags}\";\
TRESS_BUILD_TYPE=\"${CMAKE_BUILD_TYPE}\"")
