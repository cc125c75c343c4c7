#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/catalogue.h"
#include "simulation/plugin/interface_facts.h"

namespace tress::simulation {

/// Properties that must agree where a plug-in and the program that loads it are compiled,
/// since they pass each other objects. The stamp is a text "tress
/// plug-in|version=0.1.0|headers=...|...|" in the library's file, which is read before
/// the library is opened.
class BuildStamp {
 public:
  /// Composes the stamp of the code that is compiled.
  constexpr BuildStamp() {
    add("tress plug-in|");
    field("version", interface_version);
    field("headers", interface_headers);
#if defined(__clang__)
    field("compiler", "Clang ", {__clang_major__});
#else
    field("compiler", "GNU ", {__GNUC__});
#endif
#if defined(_GLIBCXX_DEBUG)
    field("containers", "checked");
#elif !defined(_GLIBCXX_USE_CXX11_ABI) || !_GLIBCXX_USE_CXX11_ABI
    field("containers", "of C++03");
#else
    field("containers", "usual");
#endif
    // They decide how wide packs are, and how Eigen aligns what it allocates.
#if defined(__AVX512F__)
    field("instructions", "AVX-512");
#elif defined(__AVX2__) && defined(__FMA__)
    field("instructions", "AVX2");
#elif defined(__AVX__)
    field("instructions", "AVX");
#else
    field("instructions", "SSE2");
#endif
#if defined(__SANITIZE_ADDRESS__)
    field("sanitizer", "address");
#else
    field("sanitizer", "none");
#endif
    field("sizes", "",
          {sizeof(System), sizeof(models::Strand), sizeof(Options),
           sizeof(models::ModelEntry), sizeof(models::EffectEntry),
           sizeof(integrators::IntegratorEntry)});
  }

  /// Returns the stamp.
  constexpr std::string_view text() const { return {text_, size_}; }

 private:
  constexpr void add(std::string_view part) {
    for (const char c : part) text_[size_++] = c;
  }
  constexpr void add(std::size_t number) {
    char digits[20] = {};
    std::size_t count = 0;
    for (; number > 0; number /= 10)
      digits[count++] = static_cast<char>('0' + number % 10);
    while (count > 0) text_[size_++] = digits[--count];
  }
  constexpr void field(std::string_view name, std::string_view words,
                       std::initializer_list<std::size_t> numbers = {}) {
    add(name);
    add("=");
    add(words);
    for (const std::size_t& number : numbers) {
      if (&number != numbers.begin()) add(",");
      add(number);
    }
    add("|");
  }

  char text_[400] = {};
  std::size_t size_ = 0;
};

}  // namespace tress::simulation
