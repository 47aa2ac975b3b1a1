#include "lab.hpp"

#include <iostream>

namespace organ_collision::bench {

const Scene& Lab::scene(const SceneKey& key) {
  std::unique_ptr<Scene>& scene = scenes_[key];
  if (!scene) {
    scene = std::make_unique<Scene>(key.shuffled ? this->scene({key.faces, false}).shuffled()
                                                 : Scene(key.faces));
  }
  return *scene;
}

Rig& Lab::rig(const std::string& name, std::unique_ptr<Engine> (*make)(), const SceneKey& key,
              bool rigid) {
  std::unique_ptr<Rig>& rig = rigs_[{name, key, rigid}];
  if (!rig) {
    rig = std::make_unique<Rig>(make(), scene(key), rigid);
    tell(name + (rigid ? ", rigid" : ""), key, rig->findings());
  }
  return *rig;
}

ContactRig& Lab::contact_rig(const SceneKey& key) {
  std::unique_ptr<ContactRig>& rig = contact_rigs_[key];
  if (!rig) {
    rig = std::make_unique<ContactRig>(scene(key));
    tell("ours, contacts", key, rig->findings());
  }
  return *rig;
}

GrasperRig& Lab::grasper_rig() {
  if (!grasper_rig_) {
    grasper_rig_ = std::make_unique<GrasperRig>();
    tell("ours, a grasper", {1224, false}, grasper_rig_->findings());
    tell("fcl, a grasper", {1224, false}, grasper_rig_->fcl_findings());
  }
  return *grasper_rig_;
}

void Lab::tell(const std::string& name, const SceneKey& key, const Findings& findings) {
  const auto& [missed, wrong] = findings.errors;
  if (name.rfind("ours", 0) == 0) own_errors_ += missed + wrong;
  std::cerr << "checked " << name << ", " << key.faces << " faces"
            << (key.shuffled ? ", shuffled: " : ": ") << findings.hits << " hits a query, missed "
            << missed << ", wrong " << wrong << " in all" << std::endl;
}

}  // namespace organ_collision::bench
