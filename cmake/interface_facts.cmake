# cmake -DROOT= -DVERSION= -DOUTPUT= -P interface_facts.cmake: the header by which plug-ins
# and programs see whether they were compiled from the same headers.
set(sum)
foreach(room math contract linear models integrators simulation)
  file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/${room}/*.h)
  list(SORT headers)
  foreach(header IN LISTS headers)
    file(SHA256 ${ROOT}/${header} one)
    string(APPEND sum "${header} ${one}\n")
  endforeach()
endforeach()
string(SHA256 sum "${sum}")
string(SUBSTRING ${sum} 0 16 sum)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once

#include <string_view>

namespace tress::simulation {

inline constexpr std::string_view interface_version = "@VERSION@";
inline constexpr std::string_view interface_headers = "@sum@";  // a checksum of them

}  // namespace tress::simulation
]])
