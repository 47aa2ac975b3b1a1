#pragma once

#include <embree3/rtcore.h>

#include <stdexcept>

namespace organ_collision::bench {

/// Embree's device, which works in the calling thread alone.
class EmbreeDevice {
 public:
  EmbreeDevice() : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (!device_) throw std::runtime_error("Embree gives no device");
  }
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  RTCDevice get() const { return device_; }

 private:
  RTCDevice device_;
};

}  // namespace organ_collision::bench
