#include "egl_displays.hpp"

#include <EGL/eglext.h>

#include <array>
#include <cstddef>
#include <cstring>

#include "egl_functions.hpp"

namespace organ_collision {
namespace {

bool contains(const char* extensions, const char* name) {
  return extensions != nullptr && std::strstr(extensions, name) != nullptr;
}

template <typename Function>
Function extension_function(const char* name) {
  return reinterpret_cast<Function>(egl().GetProcAddress(name));
}

/// The displays of devices that draw on the CPU. There, no driver of a graphics card can come
/// first.
void add_software_devices(std::vector<EGLDisplay>& displays) {
  const auto query_devices = extension_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string =
      extension_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const auto platform_display =
      extension_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (query_devices == nullptr || query_string == nullptr || platform_display == nullptr) return;
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE)
    return;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT const device = devices[static_cast<std::size_t>(i)];
    if (!contains(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
    displays.push_back(platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  }
}

/// The display of Mesa's platform without surfaces. Mesa may draw on a graphics card there.
void add_surfaceless(std::vector<EGLDisplay>& displays) {
  const auto platform_display =
      extension_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (platform_display == nullptr) return;
  displays.push_back(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
}

}  // namespace

std::vector<EGLDisplay> software_displays() {
  std::vector<EGLDisplay> displays;
  add_software_devices(displays);
  add_surfaceless(displays);
  return displays;
}

}  // namespace organ_collision
