#include "mesh_adapter/mesh_adapter_parameters.hpp"

#include <gtest/gtest.h>

#include "surface_messages.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue organ(const std::string& name) {
  XmlRpcValue organ;
  organ["name"] = name;
  organ["topic"] = "sim/" + name;
  return organ;
}

/// The refusal of two organs when the member `name` of the second one is set to `value`.
std::string refusal_of_organ(const char* name, const XmlRpcValue& value) {
  XmlRpcValue all;
  all["organs"][0] = organ("liver");
  all["organs"][0]["vertices_topic"] = "sim/liver_points";
  all["organs"][1] = organ("spleen");
  all["organs"][1][name] = value;
  try {
    parse_mesh_adapter_parameters(all);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeshAdapterParameters, EveryValueIsTaken) {
  XmlRpcValue all;
  all["collision_node"] = "/theatre/collisions";
  all["organs"][0] = organ("liver");
  all["organs"][1] = organ("spleen");
  all["organs"][1]["frame"] = "/spleen_frame";
  all["organs"][1]["vertices_topic"] = "/sim/points";
  const MeshAdapterParameters parameters = parse_mesh_adapter_parameters(all);
  EXPECT_EQ(parameters.collision_node, "/theatre/collisions");
  ASSERT_EQ(parameters.organs.size(), 2u);
  EXPECT_EQ(parameters.organs[0].name, "liver");
  EXPECT_EQ(parameters.organs[0].topic, "sim/liver");
  EXPECT_EQ(parameters.organs[0].frame, "");
  EXPECT_EQ(parameters.organs[0].vertices_topic, "");
  EXPECT_EQ(parameters.organs[1].frame, "spleen_frame");
  EXPECT_EQ(parameters.organs[1].vertices_topic, "/sim/points");
  EXPECT_TRUE(parameters.misspelt.empty());
}

TEST(MeshAdapterParameters, DefaultsAreTheDocumentedOnes) {
  XmlRpcValue all;
  all["organs"].setSize(0);
  EXPECT_EQ(parse_mesh_adapter_parameters(all).collision_node, "organ_collision");
}

TEST(MeshAdapterParameters, OrgansMustBeGiven) {
  for (const char* name : {"organ", "collision_node"}) {
    XmlRpcValue all;
    all[name] = "liver";
    EXPECT_THROW(parse_mesh_adapter_parameters(all), ParameterError);
  }
  XmlRpcValue all;
  all["organs"] = "liver";
  EXPECT_THROW(parse_mesh_adapter_parameters(all), ParameterError);
}

TEST(MeshAdapterParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  const std::string path = "~organs[1]/";
  expect_words(refusal_of_organ("name", ""), {path + "name", "not empty"});
  expect_words(refusal_of_organ("name", "liver"), {path + "name", "liver", "unique"});
  expect_words(refusal_of_organ("name", std::string(257, 'x')), {path + "name", "256 bytes"});
  expect_words(refusal_of_organ("frame", "a\nb"), {path + "frame", "control characters"});
  expect_words(refusal_of_organ("topic", 3), {path + "topic", "'3'", "text"});
  expect_words(refusal_of_organ("topic", "sim liver"), {path + "topic", "sim liver", "name"});
  expect_words(refusal_of_organ("topic", "~mesh"), {path + "topic", "'~mesh'", "not private"});
  expect_words(refusal_of_organ("topic", "sim/liver"), {path + "topic", "sim/liver", "unique"});
  expect_words(refusal_of_organ("topic", "sim/liver_points"), {path + "topic", "unique"});
  expect_words(refusal_of_organ("frame", ""), {path + "frame", "not empty"});
  expect_words(refusal_of_organ("frame", "/"), {path + "frame", "'/'", "TF frame"});
  expect_words(refusal_of_organ("vertices_topic", "sim/spleen"),
               {path + "vertices_topic", "sim/spleen", "unique"});
  expect_words(refusal_of_organ("vertices_topic", ""), {path + "vertices_topic", "not empty"});

  XmlRpcValue all;
  all["organs"][0] = organ("liver");
  all["collision_node"] = "a b";
  EXPECT_THROW(parse_mesh_adapter_parameters(all), ParameterError);
}

TEST(MeshAdapterParameters, MisspeltNamesAreReported) {
  XmlRpcValue all;
  all["organs"][0] = organ("liver");
  all["organs"][0]["frame_id"] = "liver";
  all["collision_nod"] = "/organ_collision";
  const std::vector<std::string> misspelt = parse_mesh_adapter_parameters(all).misspelt;
  ASSERT_EQ(misspelt.size(), 2u);
  expect_words(misspelt[0], {"~collision_nod ", "'collision_node'"});
  expect_words(misspelt[1], {"~organs[0]/frame_id ", "'frame'"});
}

}  // namespace
}  // namespace organ_collision
