// The component OrganCollisionLink of a SOFA scene. At the start of each step, it sends the
// surfaces of organs and the poses of tools to the nodes, with one stamp, and gives the organs the
// forces of haptic_proxy on their vertices.

#include <sofa/core/ObjectFactory.h>
#include <sofa/core/behavior/MechanicalState.h>
#include <sofa/core/topology/BaseMeshTopology.h>
#include <sofa/defaulttype/RigidTypes.h>
#include <sofa/defaulttype/VecTypes.h>
#include <sofa/helper/accessor.h>
#include <sofa/simulation/AnimateBeginEvent.h>

#include <stdexcept>

#include "ros_link.hpp"

namespace {

using sofa::core::topology::BaseMeshTopology;
using sofa::defaulttype::Rigid3Types;
using sofa::defaulttype::Vec3Types;
template <class Types>
using State = sofa::core::behavior::MechanicalState<Types>;
using sofa::core::objectmodel::BaseLink;

}  // namespace

class OrganCollisionLink : public sofa::core::objectmodel::BaseComponent {
 public:
  SOFA_CLASS(OrganCollisionLink, sofa::core::objectmodel::BaseComponent);

  sofa::Data<double> unit{initData(&unit, 1.0, "unit", "[m] the length of the scene's unit")};
  sofa::Data<double> lockstep_sec{
      initData(&lockstep_sec, 0.01, "lockstep_sec",
               "[s] how long a step waits for the forces on the shapes that it sent")};
  sofa::Data<sofa::type::vector<std::string>> proxies{
      initData(&proxies, "proxies", "tools of haptic_proxy whose forces move the organs")};
  sofa::core::objectmodel::MultiLink<OrganCollisionLink, BaseMeshTopology, BaseLink::FLAG_STOREPATH>
      organs{initLink("organs", "surfaces; each is an organ with its name")};
  sofa::core::objectmodel::MultiLink<OrganCollisionLink, State<Rigid3Types>,
                                     BaseLink::FLAG_STOREPATH>
      tools{initLink("tools", "rigid bodies; each is a TF frame below `world` with its name")};

  void init() override {
    f_listening.setValue(true);
    d_componentState.setValue(sofa::core::objectmodel::ComponentState::Invalid);
    if (!(unit.getValue() > 0.0)) {
      msg_error() << "unit is " << unit.getValue() << "; must be above 0";
      return;
    }
    for (unsigned i = 0; i < organs.size(); ++i) {
      if (organs[i] && state_of(*organs[i])) continue;
      msg_error() << "organs: " << organs.getLinkedPath(i)
                  << " is no topology with a MechanicalObject of Vec3";
      return;
    }
    for (unsigned i = 0; i < tools.size(); ++i) {
      if (tools[i] && tools[i]->getSize() == 1) continue;
      msg_error() << "tools: " << tools.getLinkedPath(i)
                  << " is no MechanicalObject of Rigid3 with one body";
      return;
    }
    try {
      link_ = std::make_unique<RosLink>(proxies.getValue(), lockstep_sec.getValue());
      d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
    } catch (const std::exception& error) {
      msg_error() << error.what();
    }
  }

  void handleEvent(sofa::core::objectmodel::Event* event) override {
    if (!link_ || !sofa::simulation::AnimateBeginEvent::checkEventType(event)) return;
    std::vector<ToolFrame> frames;
    for (const State<Rigid3Types>* tool : tools) frames.push_back(frame_of(*tool));
    std::vector<OrganSurface> surfaces;
    for (BaseMeshTopology* organ : organs) surfaces.push_back(surface_of(*organ));
    link_->send(frames, surfaces);
    for (const VertexForce& force : link_->wait_for_forces()) push(force);
  }

 private:
  static State<Vec3Types>* state_of(const BaseMeshTopology& organ) {
    return dynamic_cast<State<Vec3Types>*>(organ.getContext()->getMechanicalState());
  }

  ToolFrame frame_of(const State<Rigid3Types>& tool) const {
    const auto& poses = tool.read(sofa::core::vec_id::read_access::position)->getValue();
    const auto& p = poses.at(0).getCenter();
    const auto& q = poses.at(0).getOrientation();
    const double scale = unit.getValue();
    return {tool.getName(), {scale * p[0], scale * p[1], scale * p[2]}, {q[0], q[1], q[2], q[3]}};
  }

  OrganSurface surface_of(BaseMeshTopology& organ) const {
    OrganSurface surface{organ.getName(), {}, {}};
    const auto& state = *state_of(organ);
    for (const auto& p : state.read(sofa::core::vec_id::read_access::position)->getValue()) {
      for (int axis = 0; axis < 3; ++axis)
        surface.vertices.push_back(float(unit.getValue() * p[axis]));
    }
    for (const auto& corners : organ.getTriangles())
      surface.triangles.insert(surface.triangles.end(), corners.begin(), corners.end());
    return surface;
  }

  /// A force in newtons is divided by the unit, because SOFA's unit of force is kg unit / s^2. SOFA
  /// clears these forces at the end of the step.
  void push(const VertexForce& given) {
    auto& state = *state_of(*organs[given.organ]);
    auto forces = sofa::helper::getWriteAccessor(
        *state.write(sofa::core::vec_id::write_access::externalForce));
    if (forces.size() < state.getSize()) forces.resize(state.getSize());
    if (given.vertex >= forces.size()) return;
    for (int axis = 0; axis < 3; ++axis)
      forces[given.vertex][axis] += given.force[axis] / unit.getValue();
  }

  std::unique_ptr<RosLink> link_;
};

extern "C" {
SOFA_EXPORT_DYNAMIC_LIBRARY void initExternalModule() {}
SOFA_EXPORT_DYNAMIC_LIBRARY const char* getModuleName() { return "OrganCollisionLink"; }
SOFA_EXPORT_DYNAMIC_LIBRARY void registerObjects(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData("Connects the scene to organ_collision over ROS.")
          .add<OrganCollisionLink>());
}
}
