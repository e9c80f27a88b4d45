#include "apps/modules/module.h"

#include <dlfcn.h>

#include <cstring>
#include <stdexcept>

namespace loopgrid {
namespace {

[[noreturn]] void FailToLoad(const std::string& file, const std::string& purpose) {
  const char* reason = dlerror();
  throw std::runtime_error("cannot load " + file + ", which " + purpose + ": " +
                           (reason != nullptr ? reason : "unknown error"));
}

}  // namespace

void* LoadFromModule(const std::string& file, const std::string& function,
                     const std::string& purpose) {
  // The dynamic linker searches in the program's RUNPATH. It loads a library once, also if it is
  // asked for several times.
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) FailToLoad(file, purpose);
  const auto* version = static_cast<const char*>(dlsym(module, "loopgrid_module_version"));
  if (version == nullptr) FailToLoad(file, purpose);
  if (std::strcmp(version, LOOPGRID_VERSION) != 0) {
    throw std::runtime_error("cannot load " + file + ", which " + purpose + ": it is of version " +
                             version + ", this program of version " LOOPGRID_VERSION);
  }
  void* address = dlsym(module, function.c_str());
  if (address == nullptr) FailToLoad(file, purpose);
  return address;
}

}  // namespace loopgrid
