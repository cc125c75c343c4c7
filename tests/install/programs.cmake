# Installs the command and one program, moves the tree, and runs a shipped scene from a folder
# that has no scenes.
set(work ${BINARY_DIR}/installed_programs)
file(REMOVE_RECURSE ${work})
file(COPY ${BINARY_DIR}/experiments/simulate DESTINATION ${work}/first/libexec/tress)
file(COPY ${BINARY_DIR}/experiments/list.txt DESTINATION ${work}/first/libexec/tress)
# As cmake --install --component programs does, which also copies all other programs.
foreach(name scenes experiments/report/dist)
  get_filename_component(folder ${name} DIRECTORY)
  file(COPY ${SOURCE_DIR}/${name} DESTINATION ${work}/first/share/tress/${folder})
endforeach()
file(COPY ${SOURCE_DIR}/python/tress_command DESTINATION ${work}/first/share/tress/python)
file(COPY ${BINARY_DIR}/installed.json DESTINATION ${work}/first/share/tress)
file(COPY ${BINARY_DIR}/installed/tress DESTINATION ${work}/first/bin
     FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
foreach(destination bin/tress libexec/tress/simulate)
  if(NOT EXISTS ${work}/first/${destination})
    message(FATAL_ERROR "no ${destination}")
  endif()
endforeach()
file(RENAME ${work}/first ${work}/moved)
file(MAKE_DIRECTORY ${work}/empty)

# run(CODE word...): runs the command in the empty folder and wants this exit code.
function(run code)
  execute_process(COMMAND ${work}/moved/bin/tress ${ARGN} WORKING_DIRECTORY ${work}/empty
                  RESULT_VARIABLE found OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT found EQUAL code)
    message(FATAL_ERROR "tress ${ARGN}: exit code ${found}\n${out}${err}")
  endif()
  set(printed "${out}${err}" PARENT_SCOPE)
endfunction()

run(0 --version)
if(NOT printed MATCHES "^tress ${VERSION}\n" OR NOT printed MATCHES "instructions: ")
  message(FATAL_ERROR "--version prints ${printed}")
endif()
run(0 simulate scenes/cantilever.toml)
file(GLOB written ${work}/empty/results/simulate/cantilever-*/scenes/cantilever.csv
     ${work}/empty/results/simulate/cantilever-*/report.html)
list(LENGTH written count)
if(NOT count EQUAL 2)
  message(FATAL_ERROR "results are ${written}")
endif()
# A program finds shipped scenes, and the files that they name, without the command.
execute_process(COMMAND ${work}/moved/libexec/tress/simulate --check
                        scenes/groomed_ponytail.toml WORKING_DIRECTORY ${work}/empty
                COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${work})
