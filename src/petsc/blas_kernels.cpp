#include "samara/petsc/blas_kernels.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

#include <dlfcn.h>

namespace samara::petsc {
namespace {

/// A function of the BLAS library that has this name, or null. The program is not linked with
/// OpenBLAS itself but with Debian's alternative, which may be any library.
template <class Function>
Function* blas_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Name of the kernels in use; empty for another library than OpenBLAS.
std::string kernels_in_use() {
  const auto name = blas_function<char*()>("openblas_get_corename");
  return name == nullptr ? "" : name();
}

#if defined(__x86_64__)
/// The kernels for the vector instructions of this processor, or null where those of any processor
/// are as good.
const char* kernels_of_processor(std::string_view in_use) {
  constexpr std::array<std::string_view, 3> wide{"SkylakeX", "Cooperlake", "SapphireRapids"};
  constexpr std::array<std::string_view, 3> medium{"Haswell", "Zen", "Excavator"};
  const auto is_one_of = [&](const auto& names) {
    for (const std::string_view name : names)
      if (name == in_use) return true;
    return false;
  };
  if (is_one_of(wide)) return nullptr;
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (!is_one_of(medium) && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return "Haswell";
  return nullptr;
}
#else
const char* kernels_of_processor(std::string_view) { return nullptr; }
#endif

}  // namespace

void choose_blas_kernels() {
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  // The library reads the variable when it is loaded; these two let it read it once more. A build
  // of OpenBLAS for one processor does not have them.
  const auto forget = blas_function<void()>("gotoblas_dynamic_quit");
  const auto choose = blas_function<void()>("gotoblas_dynamic_init");
  const std::string in_use = kernels_in_use();
  if (in_use.empty() || forget == nullptr || choose == nullptr) return;
  if (std::getenv(variable) != nullptr) return;
  const char* better = kernels_of_processor(in_use);
  if (better == nullptr) return;
  setenv(variable, better, 1);
  forget();
  choose();
  unsetenv(variable);  // processes that this one starts choose for themselves
}

std::string blas_version() {
  const std::string kernels = kernels_in_use();
  const auto configuration = blas_function<char*()>("openblas_get_config");
  if (kernels.empty() || configuration == nullptr) return "BLAS";
  const std::string whole = configuration();  // "OpenBLAS 0.3.21 DYNAMIC_ARCH ..."
  const std::size_t name_end = whole.find(' ');
  return whole.substr(0, whole.find(' ', name_end + 1)) + ", " + kernels;
}

}  // namespace samara::petsc
