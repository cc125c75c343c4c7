# TRESS_BUILD_FACTS: what manifests tell of this build, as definitions for their sources.
find_package(Git QUIET)
set(tress_commit unknown)
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${PROJECT_SOURCE_DIR} rev-parse HEAD
                  OUTPUT_VARIABLE tress_commit_found OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET RESULT_VARIABLE tress_git_failed)
  if(NOT tress_git_failed)
    set(tress_commit ${tress_commit_found})
  endif()
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" tress_build_type)
set(TRESS_BUILD_FACTS "TRESS_VERSION=\"${PROJECT_VERSION}\";TRESS_GIT_COMMIT=\"${tress_commit}\";\
TRESS_SOURCE_TREE=\"${PROJECT_SOURCE_DIR}\";\
TRESS_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\";\
TRESS_FLAGS=\"${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${tress_build_type}}\";\
TRESS_BUILD_TYPE=\"${CMAKE_BUILD_TYPE}\"")
