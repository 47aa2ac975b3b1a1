/// contact_adapter: turns the collision node's contacts into a wrench, forces on vertices and a
/// list of faces for each pair of organ and tool.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ForceState.h>
#include <organ_collision/VertexForces.h>
#include <ros/names.h>
#include <ros/ros.h>
#include <std_msgs/UInt32MultiArray.h>

#include <chrono>
#include <map>

#include "common/messages/checked_messages.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "common/program/program.hpp"
#include "contact_adapter_parameters.hpp"
#include "force_law.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr char kProgram[] = "contact_adapter";
/// The topic of the face list of an organ and a tool, below ~ORGAN/TOOL.
constexpr char kFaces[] = "faces", kState[] = "state";

// [messages] Late forces would be wrong, so only a few messages may wait, for all organs and tools.
constexpr std::uint32_t kQueue = 20;

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp contact_adapter_help() {
  const std::string pair = "~ORGAN/TOOL";
  ProgramHelp help{
      kProgram,
      "Turns the contacts of the collision node into a wrench, forces on vertices and a list of "
      "faces for each organ and tool. max_force limits the force. The topics of an organ and a "
      "tool appear with the first answer about them. " +
          std::string(kPairNamesHelp)};
  help.subscribed = {{ros::names::append(names::kNode, names::kContacts),
                      message_type<ContactArray>(),
                      "the contacts. Remap it if the collision node has another name"}};
  help.published = {
      {ros::names::append(pair, names::kWrench), message_type<geometry_msgs::WrenchStamped>(),
       "force of the tissue on the tool [N], torque about the origin of the organ's frame [N m], "
       "with the frame and stamp of the contacts. Zero if nothing is touched"},
      {ros::names::append(pair, names::kVertexForces), message_type<VertexForces>(),
       "forces of the tool on the tissue's vertices [N]; together, minus the wrench"},
      {ros::names::append(pair, kState), message_type<ForceState>(),
       "for each answer of the collision node: whether there is a wrench, and why not, or what the "
       "force may lack"},
      {ros::names::append(pair, kFaces), message_type<std_msgs::UInt32MultiArray>(),
       "the numbers of the touched faces, ascending, each once"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "number of messages, of those without output by reason, of clipped forces"}};
  help.services = {LiveParameters::help()};
  help.services[0].name = "~" + help.services[0].name;
  help.parameters = parameter_help<ContactAdapterParameters>();
  help.further =
      "roslaunch organ_collision contact_adapter.launch starts it. doc/forces.md explains the law "
      "of the force.";
  return help;
}

/// The node. It logs and counts an answer that reports a failure, and publishes only its state,
/// because the contacts are unknown then. All its work is done in the callbacks of the node's
/// queue, which must be called from one thread.
class ContactAdapter {
 public:
  /// Throws ParameterError.
  ContactAdapter(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : private_node_(private_node),
        table_(load_parameters(parameters_, private_node)),
        live_parameters_(private_node, table_,
                         [this](const XmlRpc::XmlRpcValue& changes) { table_.change(changes); }),
        diagnostics_(node, private_node, parameters_.diagnostic_period_sec) {
    for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());
    live_parameters_.advertise();
    diagnostics_.updater().add("contacts", this, &ContactAdapter::diagnose);
    subscriber_ = subscribe_checked<ContactArray>(
        node, ros::names::append(names::kNode, names::kContacts), kQueue,
        [this](const auto& event) { on_contacts(*event.getConstMessage()); }, failures_);
    ROS_INFO("ready: contacts of %s, %g N/m", subscriber_.getTopic().c_str(),
             parameters_.stiffness);
  }

 private:
  struct Pair {
    ros::Publisher faces;
    ros::Publisher wrench;
    ros::Publisher vertex_forces;
    ros::Publisher state;
    ForceLaw law;
    /// When the law was last evaluated. Steady time, because the stamps of a tool stop advancing if
    /// its poses are not published while it rests.
    std::chrono::steady_clock::time_point evaluated = {};
  };

  void on_contacts(const ContactArray& message) {
    ++received_;
    try {
      if (message.status != ContactArray::OK) {
        const std::string reason = reason_of(message.status);
        throw Rejection(message.status, reason, message.message.empty() ? reason : message.message);
      }
      check_contacts(message);
      publish(message, pair_of(message.organ, message.tool));
    } catch (const Rejection& rejection) {
      failures_.add(rejection.reason(),
                    "organ '" + plain_text(message.organ, kLongestName) + "', tool '" +
                        plain_text(message.tool, kLongestName) + "': " + rejection.what(),
                    std::chrono::steady_clock::now());
      tell_no_force(message, rejection.what());
    }
  }

  /// Publishes why an answer gives no force, if its names can be those of topics.
  void tell_no_force(const ContactArray& contacts, const std::string& why) {
    try {
      check_name("organ", contacts.organ);
      check_name("tool", contacts.tool);
      if (!contacts.tool.empty())
        tell(contacts, pair_of(contacts.organ, contacts.tool), false, why);
    } catch (const Rejection&) {  // It was counted when the answer was refused, or will be.
    }
  }

  static void tell(const ContactArray& contacts, Pair& pair, bool known, const std::string& why) {
    ForceState state;
    state.header = contacts.header;
    state.organ = contacts.organ;
    state.tool = contacts.tool;
    state.known = known;
    state.message = plain_text(why, kLongestMessage);
    pair.state.publish(state);
  }

  void publish(const ContactArray& contacts, Pair& pair) {
    std::vector<FaceForce> forces;
    if (has_geometry(contacts)) {
      forces = forces_of(contacts, pair);
      geometry_msgs::WrenchStamped wrench;
      wrench.header = contacts.header;
      wrench.wrench = wrench_of(forces);
      pair.wrench.publish(wrench);
      tell(contacts, pair, true, parameters_.way_out ? doubt_about_side(contacts) : "");
    } else {
      tell(contacts, pair, false, "contacts of the paper's modes have no depth");
    }
    pair.faces.publish(face_list(contacts));
    if (has_geometry(contacts)) pair.vertex_forces.publish(vertex_forces(contacts, forces));
  }

  std::vector<FaceForce> forces_of(const ContactArray& contacts, Pair& pair) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - pair.evaluated).count();
    pair.evaluated = now;
    std::vector<FaceForce> forces =
        pair.law.follow(contacts, seconds, parameters_.stiffness, radius_of(contacts.tool));
    if (limit_force(forces, parameters_.max_force)) {
      clipped_.add("max_force",
                   "organ '" + contacts.organ + "', tool '" + contacts.tool +
                       "': the force is clipped to " + std::to_string(parameters_.max_force) + " N",
                   now);
    }
    return forces;
  }

  /// Reads the parameters of the node that publishes the contacts. The cached look-up notices
  /// changes of the parameter, and does not call the parameter server each time.
  ShaftRadius radius_of(const std::string& tool) const {
    XmlRpc::XmlRpcValue tools;
    const std::string node = ros::names::parentNamespace(subscriber_.getTopic());
    ros::param::getCached(ros::names::append(node, names::kTools), tools);
    return shaft_radius(tools, tool);
  }

  Pair& pair_of(const std::string& organ, const std::string& tool) {
    const auto known = pairs_.find({organ, tool});
    if (known != pairs_.end()) return known->second;
    if (!radius_of(tool)) {
      ROS_INFO("the radius of tool '%s' is not known: past a face its contacts tell the depth",
               tool.c_str());
    }
    const std::string pair = names_.of(organ, tool);
    const auto topic = [&pair](const char* name) { return ros::names::append(pair, name); };
    return pairs_
        .insert(
            {{organ, tool},
             {private_node_.advertise<std_msgs::UInt32MultiArray>(topic(kFaces), kQueue),
              private_node_.advertise<geometry_msgs::WrenchStamped>(topic(names::kWrench), kQueue),
              private_node_.advertise<VertexForces>(topic(names::kVertexForces), kQueue),
              private_node_.advertise<ForceState>(topic(kState), kQueue),
              ForceLaw(parameters_.way_out)}})
        .first->second;
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    using diagnostic_msgs::DiagnosticStatus;
    status.summary(DiagnosticStatus::OK,
                   std::to_string(pairs_.size()) + " pairs of organ and tool");
    if (received_ == 0) {
      status.summary(DiagnosticStatus::WARN, "nothing came yet on " + subscriber_.getTopic());
    }
    status.add("messages", received_);
    for (const std::string& sentence : parameters_.misspelt) {
      status.mergeSummary(DiagnosticStatus::WARN, sentence);
    }
    show_failures("unpublished", failures_, status);
    show_failures("clipped", clipped_, status);
  }

  ros::NodeHandle private_node_;
  ContactAdapterParameters parameters_;
  ParameterTable table_;
  LiveParameters live_parameters_;
  PairNames names_;
  std::map<std::pair<std::string, std::string>, Pair> pairs_;  ///< by organ and tool
  std::uint64_t received_ = 0;  ///< messages, including those that report a failure
  FailureLog failures_;
  FailureLog clipped_;  ///< wrenches whose force was reduced to max_force
  Diagnostics diagnostics_;
  ros::Subscriber subscriber_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, contact_adapter_help(), kProgram,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       const ContactAdapter adapter(node, private_node);
                       ros::spin();
                     });
}
