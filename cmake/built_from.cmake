# cmake -DGIT=git -DROOT=tree -DOUTPUT=header -P built_from.cmake: the commit of the tree, and
# a checksum of what differs from it, as a header that is written only when it changes.
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
set(changes "")
# What is compiled, or says how.
set(compiled VERSION CMakeLists.txt CMakePresets.json cmake math contract linear models integrators
    simulation experiments python ":(exclude)experiments/report" ":(exclude)*.md"
    ":(exclude)*.mjs" ":(exclude)*.py")

# git(VARIABLE argument...): what git prints; "failed" where it fails, or hangs.
function(git variable)
  execute_process(COMMAND ${GIT} --no-optional-locks -C ${ROOT} ${ARGN}
                  OUTPUT_VARIABLE printed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE status TIMEOUT 20)
  if(NOT status STREQUAL "0")
    set(printed failed)
  endif()
  set(${variable} "${printed}" PARENT_SCOPE)
endfunction()

# Not of a repository around the tree.
if(GIT AND EXISTS ${ROOT}/.git)
  git(found rev-parse HEAD)
  if(NOT found STREQUAL "failed")
    set(commit ${found})
    git(differences diff --no-ext-diff --no-textconv --binary HEAD -- ${compiled})
    git(further ls-files --others --exclude-standard -- ${compiled})
    if(NOT "${differences}${further}" STREQUAL "")
      string(SHA256 changes "${differences}\n${further}")
      string(SUBSTRING ${changes} 0 16 changes)
    endif()
  endif()
endif()

# A source archive has no .git: `git archive` and the sdist of Python write the commit here.
if(commit STREQUAL "unknown" AND EXISTS ${ROOT}/cmake/commit.txt)
  file(STRINGS ${ROOT}/cmake/commit.txt archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    set(commit ${archived})
  endif()
endif()

set(text "// Made by cmake/built_from.cmake.
#define TRESS_GIT_COMMIT \"${commit}\"
#define TRESS_GIT_CHANGES \"${changes}\"
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
