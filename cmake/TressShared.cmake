# TRESS_SHARED: what programs have in common is one library, so that twenty of them are
# little larger than one. It is theirs alone; others link the static libraries.
if(TRESS_SHARED)
  set(tress_whole math contract linear models integrators simulation run numerics)
  list(TRANSFORM tress_whole PREPEND tress_)
  file(CONFIGURE OUTPUT shared.cpp CONTENT "// all of it comes from static libraries\n")
  add_library(tress_shared SHARED ${CMAKE_CURRENT_BINARY_DIR}/shared.cpp)
  list(TRANSFORM tress_whole REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
  target_link_options(tress_shared PRIVATE LINKER:--whole-archive ${archives}
                      LINKER:--no-whole-archive)
  target_link_libraries(tress_shared PRIVATE ${tress_whole})
  set_target_properties(tress_shared PROPERTIES OUTPUT_NAME tress LINK_DEPENDS "${archives}"
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  install(TARGETS tress_shared LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/tress
          COMPONENT programs NAMELINK_SKIP)
  file(RELATIVE_PATH tress_shared_folder /${CMAKE_INSTALL_LIBEXECDIR}/tress
       /${CMAKE_INSTALL_LIBDIR}/tress)
endif()
