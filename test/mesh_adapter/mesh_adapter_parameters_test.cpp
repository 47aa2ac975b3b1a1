#include "mesh_adapter/mesh_adapter_parameters.hpp"

#include "test/ros/parameters/parameter_tables.hpp"

namespace organ_collision {

using XmlRpc::XmlRpcValue;

template <>
XmlRpcValue legal_parameters<MeshAdapterParameters>() {
  XmlRpcValue all;
  all["organs"].setSize(0);
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(MeshAdapter, ParameterTableTest, MeshAdapterParameters);

namespace {

XmlRpcValue organ(const std::string& name) {
  XmlRpcValue organ;
  organ["name"] = name;
  organ["topic"] = "sim/" + name;
  return organ;
}

/// The refusal of two organs when the member `name` of the second one is set to `value`.
std::string refusal_of_organ(const char* name, const XmlRpcValue& value) {
  XmlRpcValue organs;
  organs[0] = organ("liver");
  organs[0]["vertices_topic"] = "sim/liver_points";
  organs[1] = organ("spleen");
  organs[1][name] = value;
  return refusal_of<MeshAdapterParameters>("organs", organs);
}

TEST(MeshAdapterParameters, EveryValueIsTaken) {
  XmlRpcValue all;
  all["collision_node"] = "/theatre/collisions";
  all["organs"][0] = organ("liver");
  all["organs"][1] = organ("spleen");
  all["organs"][1]["frame"] = "/spleen_frame";
  all["organs"][1]["vertices_topic"] = "/sim/points";
  const MeshAdapterParameters parameters = parse_parameters<MeshAdapterParameters>(all);
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

TEST(MeshAdapterParameters, OrgansMustBeGiven) {
  for (const char* name : {"organ", "collision_node"}) {
    XmlRpcValue all;
    all[name] = "liver";
    EXPECT_THROW(parse_parameters<MeshAdapterParameters>(all), ParameterError);
  }
  XmlRpcValue all;
  all["organs"] = "liver";
  EXPECT_THROW(parse_parameters<MeshAdapterParameters>(all), ParameterError);
}

TEST(MeshAdapterParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  const std::string path = "~organs[1]/";
  expect_contains(refusal_of_organ("name", ""), {path + "name", "not empty"});
  expect_contains(refusal_of_organ("name", "liver"), {path + "name", "liver", "unique"});
  expect_contains(refusal_of_organ("name", std::string(257, 'x')), {path + "name", "256 bytes"});
  expect_contains(refusal_of_organ("frame", "a\nb"), {path + "frame", "control characters"});
  expect_contains(refusal_of_organ("topic", 3), {path + "topic", "'3'", "text"});
  expect_contains(refusal_of_organ("topic", "sim liver"), {path + "topic", "sim liver", "name"});
  expect_contains(refusal_of_organ("topic", "~mesh"), {path + "topic", "'~mesh'", "not private"});
  expect_contains(refusal_of_organ("topic", "sim/liver"), {path + "topic", "sim/liver", "unique"});
  expect_contains(refusal_of_organ("topic", "sim/liver_points"), {path + "topic", "unique"});
  expect_contains(refusal_of_organ("frame", ""), {path + "frame", "not empty"});
  expect_contains(refusal_of_organ("frame", "/"), {path + "frame", "'/'", "TF frame"});
  expect_contains(refusal_of_organ("vertices_topic", "sim/spleen"),
                  {path + "vertices_topic", "sim/spleen", "unique"});
  expect_contains(refusal_of_organ("vertices_topic", ""), {path + "vertices_topic", "not empty"});

  expect_contains(refusal_of<MeshAdapterParameters>("collision_node", "a b"),
                  {"~collision_node is 'a b'", "not private"});
}

TEST(MeshAdapterParameters, MisspeltNamesAreReported) {
  XmlRpcValue all;
  all["organs"][0] = organ("liver");
  all["organs"][0]["frame_id"] = "liver";
  all["collision_nod"] = "/organ_collision";
  const std::vector<std::string> misspelt = parse_parameters<MeshAdapterParameters>(all).misspelt;
  ASSERT_EQ(misspelt.size(), 2u);
  expect_contains(misspelt[0], {"~collision_nod ", "'collision_node'"});
  expect_contains(misspelt[1], {"~organs[0]/frame_id ", "'frame'"});
}

}  // namespace
}  // namespace organ_collision
