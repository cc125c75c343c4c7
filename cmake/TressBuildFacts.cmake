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
set(TRESS_BUILD_FACTS "TRESS_VERSION=\"${PROJECT_VERSION}\";\
TRESS_SOURCE_TREE=\"${PROJECT_SOURCE_DIR}\";\
TRESS_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\";\
TRESS_FLAGS=\"${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${tress_build_type}}\";\
TRESS_BUILD_TYPE=\"${CMAKE_BUILD_TYPE}\"")
