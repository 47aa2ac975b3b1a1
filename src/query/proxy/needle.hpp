#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "tissue.hpp"

namespace organ_collision {

/// A needle in tissue: the shaft of a proxy through a trocar, after its tip has pierced a face. The
/// point of the face where the needle entered, the entry, moves with the tissue and holds the
/// needle sideways: the axis always goes from the trocar through the entry. Along the axis, the
/// needle sticks and slides with friction. Its tip stops at the next face until it pierces this
/// face as well. Faces beside the needle do not act on it.
class Needle {
 public:
  /// Returns a needle if the proxy's tip presses on tissue hard enough to pierce it, else nothing.
  /// `contacts`: the contacts that hold the proxy.
  static std::optional<Needle> pierce(const ShaftAxis& proxy, const ShaftAxis& hand,
                                      const std::vector<ProxyFace>& contacts,
                                      const std::vector<ProxyOrgan>& organs,
                                      const ProxySettings& settings, Tissue& tissue);

  /// What became of the needle.
  enum class Fate {
    kHeld,       ///< tissue holds it
    kPulledOut,  ///< the tip has left the tissue; axis() says where it is
    kLost        ///< the face of the entry is gone, or the entry is too near the trocar
  };
  /// Moves the needle with the hand and the tissue.
  Fate follow(const ShaftAxis& hand, const std::vector<ProxyOrgan>& organs,
              const ProxySettings& settings, Tissue& tissue);

  const ShaftAxis& axis() const { return axis_; }
  /// Where the needle goes through faces, from the entry to the tip. Only the entry has a load.
  const std::vector<ProxyCrossing>& crossings() const { return crossings_; }

 private:
  Needle(std::string organ, const ProxyCrossing& entry, const FaceIndices& corners)
      : organ_(std::move(organ)), entry_(entry), corners_(corners) {}

  bool find_entry(const std::vector<ProxyOrgan>& organs);
  double stop_at_faces(double from, double hand_tip, const ProxySettings& settings,
                       Tissue& tissue) const;
  void describe(const ShaftAxis& hand, Tissue& tissue);
  bool is_entry(const ProxyCrossing& crossing) const {
    return crossing.organ == entry_.organ && crossing.face == entry_.face;
  }

  std::string organ_;  ///< the name of the organ that the needle entered
  ProxyCrossing entry_;
  FaceIndices corners_ = {};  ///< the corners of the face of the entry
  double inserted_ = 0.0;     ///< [m] the distance from the entry to the tip
  ShaftAxis axis_;
  std::vector<ProxyCrossing> crossings_;
};

}  // namespace organ_collision
