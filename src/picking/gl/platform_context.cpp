#include "platform_context.hpp"

#include <dlfcn.h>

#include "organ_collision/picking/gl_error.hpp"

namespace organ_collision {

SharedLibrary::SharedLibrary(const char* name)
    : name_(name), handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
  if (handle_ == nullptr) throw GlError(dlerror());
}

void* SharedLibrary::find(const char* name) const {
  void* const function = dlsym(handle_, name);
  if (function == nullptr) throw GlError(std::string(name_) + " has no function " + name);
  return function;
}

}  // namespace organ_collision
