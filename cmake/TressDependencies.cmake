# Every library, found once. SUNDIALS: `./tress setup` builds a Release copy and names it in
# TRESS_SUNDIALS_ROOT, because Debian's package is compiled at -O0 (3 to 7 times slower).
set(TRESS_SUNDIALS_ROOT "$ENV{TRESS_SUNDIALS_ROOT}" CACHE PATH "Release build of SUNDIALS")
set(TRESS_SUNDIALS_COMPONENTS ida cvode arkode nvecserial)
if(TRESS_SUNDIALS_ROOT AND NOT "${SUNDIALS_DIR}" MATCHES "^${TRESS_SUNDIALS_ROOT}/")
  unset(SUNDIALS_DIR CACHE)  # an earlier answer to another question
endif()
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS ${TRESS_SUNDIALS_COMPONENTS}
             HINTS ${TRESS_SUNDIALS_ROOT})
if(NOT TRESS_SUNDIALS_ROOT)
  message(WARNING "SUNDIALS from ${SUNDIALS_DIR}: Debian's binary is compiled at -O0, do not "
                  "compare timings. `./tress setup` builds a Release copy.")
endif()
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(GSL 2.7 REQUIRED)
find_package(KLU REQUIRED)

if(TRESS_EXPERIMENTS OR TRESS_TESTS)
  find_package(fmt REQUIRED)
  find_package(CLI11 REQUIRED)
  find_package(tomlplusplus REQUIRED)
  find_package(nlohmann_json REQUIRED)
  find_package(Threads REQUIRED)
  find_package(TBB REQUIRED)
  find_package(HDF5C REQUIRED)
  find_package(ZLIB REQUIRED)
endif()
if(TRESS_TESTS)
  find_package(GTest REQUIRED)
endif()
if(TRESS_BENCHMARKS)
  find_package(benchmark 1.7 REQUIRED)
endif()
