#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "tissue.hpp"

namespace organ_collision {

/// A needle in tissue: the shaft of a proxy through a trocar whose tip has pierced a face. The
/// point of the face that it entered holds it sideways: the axis goes from the trocar through that
/// point, wherever the tissue moves it. Along the axis it sticks and slides with friction. Its tip
/// stops at the next face, until it pierces that as well. Faces beside the needle do not touch it.
class Needle {
 public:
  /// A needle if the proxy's tip presses on tissue hard enough to pierce it. `contacts`: what holds
  /// the proxy.
  static std::optional<Needle> pierce(const ShaftAxis& proxy, const ShaftAxis& hand,
                                      const std::vector<ProxyContact>& contacts,
                                      const std::vector<ProxyOrgan>& organs,
                                      const ProxySettings& settings, Tissue& tissue);

  /// What became of the needle.
  enum class Fate {
    kHeld,       ///< tissue holds it
    kPulledOut,  ///< its tip is out of the tissue, at axis()
    kLost        ///< the face that it entered is gone, or has come to the trocar
  };
  /// Moves the needle with the hand and the tissue.
  Fate follow(const ShaftAxis& hand, const std::vector<ProxyOrgan>& organs,
              const ProxySettings& settings, Tissue& tissue);

  const ShaftAxis& axis() const { return axis_; }
  /// From the entry to the tip. The whole load is at the entry.
  const std::vector<ProxyCrossing>& crossings() const { return crossings_; }

 private:
  Needle(std::string organ, const ProxyCrossing& entry, const FaceIndices& corners)
      : organ_(std::move(organ)), entry_(entry), corners_(corners) {}

  bool find_entry(const std::vector<ProxyOrgan>& organs);
  double stop_at_faces(double from, double hand_tip, const ProxySettings& settings,
                       Tissue& tissue) const;
  void describe(const ShaftAxis& hand, Tissue& tissue);

  std::string organ_;  ///< the name of the organ that it entered
  ProxyCrossing entry_;
  FaceIndices corners_ = {};  ///< of the face that it entered
  double inserted_ = 0.0;     ///< [m] from the entry to the tip, along the axis
  ShaftAxis axis_;
  std::vector<ProxyCrossing> crossings_;
};

}  // namespace organ_collision
