#pragma once

#include <string>

namespace organ_collision {

/// A shared library that is loaded when it is first needed, so that the package builds and runs
/// without it. It stays loaded until the process ends: Mesa does not survive being unloaded.
class SharedLibrary {
 public:
  /// Loads the library of this name, for example "libEGL.so.1". Throws GlError with the reason.
  explicit SharedLibrary(const char* name);

  /// Sets `function` to the library's function of this name. Throws GlError if it has none.
  template <typename Function>
  void load(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(find(name));
  }

 private:
  void* find(const char* name) const;

  const char* name_;
  void* handle_;
};

}  // namespace organ_collision
