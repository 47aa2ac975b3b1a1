// The tables of parameters of haptic_proxy and organ_mesh_adapter.
#include "adapters/mesh_adapter_parameters.hpp"
#include "haptics/haptic_proxy_parameters.hpp"
#include "test/node/parameters/parameter_tables.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {

using XmlRpc::XmlRpcValue;

template <>
XmlRpcValue legal_parameters<HapticProxyParameters>() {
  XmlRpcValue all;
  all["tools"][0]["name"] = "left hook";
  all["tools"][0]["trocar_frame"] = "trocar";
  all["tools"][0]["tip_frame"] = "tip";
  all["tools"][0]["radius"] = 0.005;
  return all;
}

template <>
XmlRpcValue legal_parameters<MeshAdapterParameters>() {
  XmlRpcValue all;
  all["organs"].setSize(0);
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(HapticProxy, ParameterTableTest, HapticProxyParameters);
INSTANTIATE_TYPED_TEST_SUITE_P(MeshAdapter, ParameterTableTest, MeshAdapterParameters);

namespace {

XmlRpcValue organ(const std::string& name) {
  XmlRpcValue organ;
  organ["name"] = name;
  organ["topic"] = "sim/" + name;
  return organ;
}

XmlRpcValue kept(const XmlRpcValue& organ, const XmlRpcValue& side) {
  XmlRpcValue entry;
  entry["organ"] = organ;
  entry["side"] = side;
  return entry;
}

TEST(HapticParameters, AreTaken) {
  XmlRpcValue all = legal_parameters<HapticProxyParameters>();
  EXPECT_EQ(parse_parameters<HapticProxyParameters>(all).frame, "");
  all["frame"] = "/world";
  all["picker"] = "cpu";
  const auto proxy = parse_parameters<HapticProxyParameters>(all);
  EXPECT_EQ(proxy.frame, "world");
  EXPECT_EQ(proxy.picker.kind, PickerKind::kCpu);
  EXPECT_TRUE(proxy.keep.empty());
  all["keep"][0] = kept("left bladder", "inside");
  all["keep"][1] = kept("colon", "either");
  all["keep"][2] = kept("liver", "outside");
  all["keep"][2]["sides"] = "inside";
  const auto with = parse_parameters<HapticProxyParameters>(all);
  EXPECT_EQ(with.keep, (std::map<std::string, Side>{{"left bladder", Side::kInside},
                                                    {"colon", Side::kUnknown},
                                                    {"liver", Side::kOutside}}));
  ASSERT_EQ(with.misspelt.size(), 1U);
  expect_words(with.misspelt[0], {"~keep[2]/sides ", "'side'"});

  XmlRpcValue adapter;
  adapter["collision_node"] = "/theatre/collisions";
  adapter["organs"][0] = organ("liver");
  adapter["organs"][1] = organ("spleen");
  adapter["organs"][1]["frame"] = "/spleen_frame";
  adapter["organs"][1]["vertices_topic"] = "/sim/points";
  adapter["organs"][1]["frame_id"] = "liver";
  const MeshAdapterParameters meshes = parse_parameters<MeshAdapterParameters>(adapter);
  EXPECT_EQ(meshes.collision_node, "/theatre/collisions");
  ASSERT_EQ(meshes.organs.size(), 2u);
  EXPECT_EQ(meshes.organs[0].name, "liver");
  EXPECT_EQ(meshes.organs[0].topic, "sim/liver");
  EXPECT_EQ(meshes.organs[0].frame, "");
  EXPECT_EQ(meshes.organs[0].vertices_topic, "");
  EXPECT_EQ(meshes.organs[1].frame, "spleen_frame");
  EXPECT_EQ(meshes.organs[1].vertices_topic, "/sim/points");
  ASSERT_EQ(meshes.misspelt.size(), 1u);
  expect_words(meshes.misspelt[0], {"~organs[1]/frame_id ", "'frame'"});
  XmlRpcValue without_organs;
  without_organs["collision_node"] = "liver";
  EXPECT_THROW(parse_parameters<MeshAdapterParameters>(without_organs), ParameterError);
}

TEST(HapticParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  EXPECT_EQ(refusal_of<HapticProxyParameters>("frame", "/"),
            "~frame is '/'; must be the name of a TF frame");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("clearance", -1.5),
            "~clearance is '-1.5'; must be a number, above 0, up to 0.1");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("max_force", 0),
            "~max_force is '0'; must be a number, above 0, up to 10000, or .inf");
  XmlRpcValue keep;
  EXPECT_EQ(refusal_of<HapticProxyParameters>("keep", "inside"),
            "~keep is the text 'inside'; must be a list of groups of organ and side");
  keep[0] = kept("colon", "left");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/side is 'left'"});
  keep[0] = kept("", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/organ is ''"});
  keep[0] = keep[1] = kept("colon", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[1]/organ", "unique"});
  XmlRpcValue tools;
  tools[0] = tools[1] = legal_parameters<HapticProxyParameters>()["tools"][0];
  tools[1]["name"] = "left_hook";  // Its topics would have the same names.
  expect_words(refusal_of<HapticProxyParameters>("tools", tools),
               {"~tools has 'left hook' and 'left_hook'"});
  expect_words(refusal_of<MeshAdapterParameters>("collision_node", "a b"),
               {"~collision_node is 'a b'", "not private"});
  const struct {
    const char* name;  ///< of a member of the second organ
    XmlRpcValue value;
    std::vector<std::string> words;
  } rows[] = {
      {"name", "", {"not empty"}},
      {"name", "liver", {"liver", "unique"}},
      {"name", std::string(257, 'x'), {"256 bytes"}},
      {"frame", "a\nb", {"control characters"}},
      {"frame", "", {"not empty"}},
      {"frame", "/", {"'/'", "TF frame"}},
      {"topic", 3, {"'3'", "text"}},
      {"topic", "sim liver", {"sim liver", "name"}},
      {"topic", "~mesh", {"'~mesh'", "not private"}},
      {"topic", "sim/liver", {"sim/liver", "unique"}},
      {"topic", "sim/liver_points", {"unique"}},
      {"vertices_topic", "sim/spleen", {"sim/spleen", "unique"}},
      {"vertices_topic", "", {"not empty"}},
      {"scale", 0, {"'0'", "above 0"}},
      {"scale", -0.001, {"above 0"}},
      {"scale", kUnlimited, {"above 0"}},
      {"scale", "1e-3", {"without quotes"}},
  };
  for (const auto& row : rows) {
    XmlRpcValue organs;
    organs[0] = organ("liver");
    organs[0]["vertices_topic"] = "sim/liver_points";
    organs[1] = organ("spleen");
    organs[1][row.name] = row.value;
    const std::string refusal = refusal_of<MeshAdapterParameters>("organs", organs);
    expect_words(refusal, {std::string("~organs[1]/") + row.name});
    expect_words(refusal, row.words);
  }
}

XmlRpcValue clearance(const char* organ, const char* link, double value) {
  XmlRpcValue entry;
  entry.begin();  // Makes it an empty group.
  if (*organ) entry["organ"] = organ;
  if (*link) entry["link"] = link;
  if (value > 0.0) entry["value"] = value;
  if (value == 0.0) entry["ignored"] = true;
  return entry;
}

/// The parameters of a shaft with two links, and of a tool without links.
XmlRpcValue with_clearances() {
  XmlRpcValue all = legal_parameters<HapticProxyParameters>();
  all["tools"][1]["name"] = "grasper";
  all["tools"][1]["links"][0] = "wrist";
  all["tools"][1]["links"][1] = "jaw";
  return all;
}

/// Of all entries that match, in the words of the reference.
double expected_clearance(const std::vector<ClearanceEntry>& entries, const std::string& organ,
                          const std::string& link) {
  const std::pair<std::string, std::string> ranks[] = {{organ, link}, {organ, ""}, {"", link}};
  for (const auto& [of_organ, of_link] : ranks) {
    double largest = -1.0;
    for (const ClearanceEntry& entry : entries) {
      if (entry.organ != of_organ || entry.link != of_link) continue;
      largest = std::max(largest, entry.value);
    }
    if (largest >= 0.0) return largest;
  }
  double fallback = 0.0;
  for (const ClearanceEntry& entry : entries) {
    if (entry.organ.empty() && entry.link.empty()) fallback = std::max(fallback, entry.value);
  }
  return fallback > 0.0 ? fallback : ProxySettings().clearance;
}

TEST(HapticParameters, AClearanceIsThatOfTheMostExactEntry) {
  const std::vector<std::string> organs = {"liver", "colon", "bladder"};
  const std::vector<std::string> links = {"shaft", "wrist", "jaw"};
  oracle::Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    XmlRpcValue all = with_clearances();
    std::vector<ClearanceEntry> entries;
    all["clearance"].setSize(0);
    for (int i = random.integer(0, 8); i > 0; --i) {
      ClearanceEntry entry;
      if (random.chance(0.6)) entry.organ = organs[static_cast<std::size_t>(random.integer(0, 1))];
      if (random.chance(0.6)) entry.link = links[static_cast<std::size_t>(random.integer(0, 2))];
      const bool is_ignored = !entry.organ.empty() && !entry.link.empty() && random.chance(0.3);
      entry.value = is_ignored ? 0.0 : 1e-4 * random.integer(1, 5);
      all["clearance"][static_cast<int>(entries.size())] =
          clearance(entry.organ.c_str(), entry.link.c_str(), entry.value);
      entries.push_back(entry);
    }
    const auto p = parse_parameters<HapticProxyParameters>(all);
    for (const std::string& organ : organs) {
      for (const std::string& link : links) {
        EXPECT_EQ(clearance_of(p, organ, link), expected_clearance(entries, organ, link)) << trial;
      }
    }
  }
}

TEST(HapticParameters, IllegalEntriesOfClearanceAreNamed) {
  const auto refusal = [](const XmlRpcValue& entry) {
    XmlRpcValue all = with_clearances();
    all["clearance"][0] = clearance("liver", "", 2e-3);
    all["clearance"][1] = entry;
    return refusal_by<ParameterError>([&] { parse_parameters<HapticProxyParameters>(all); });
  };
  EXPECT_EQ(refusal(clearance("liver", "shaft", 1e-5)), "accepted");
  EXPECT_EQ(refusal(clearance("liver", "jaws", 1e-3)),
            "~clearance[1]/link is 'jaws'; must be a link of a tool; nearest is 'jaw', legal are "
            "shaft, wrist, jaw");
  expect_words(refusal(clearance("liver", "jaw", 9e-6)),
               {"~clearance[1]/value is '9e-06'; must be a number, 1e-05 to 0.1"});
  expect_words(refusal(clearance("", "jaw", -1.0)), {"~clearance[1]/value is missing"});
  expect_words(refusal(clearance("", "jaw", 0.0)), {"~clearance[1]/ignored is '1'", "organ"});
  expect_words(refusal(clearance("", "", 0.0)), {"~clearance[1]/ignored", "organ and link"});
  XmlRpcValue entry = clearance("liver", "jaw", 1e-3);
  entry["ignored"] = true;
  expect_words(refusal(entry), {"~clearance[1]/value", "left out"});
  entry = clearance("liver", "jaw", 1e-3);
  entry["organs"] = "liver";
  expect_words(refusal(entry), {"~clearance[1]/organs is no parameter", "'organ'"});
}

TEST(HapticParameters, AListOfClearancesStaysUntilAnotherOneOrANumberComes) {
  XmlRpcValue all = with_clearances();
  all["clearance"][0] = clearance("liver", "jaw", 2e-3);
  all["clearance"][1] = clearance("", "", 5e-4);
  auto p = parse_parameters<HapticProxyParameters>(all);
  const ParameterTable table = table_of(p);
  XmlRpcValue change;
  change["stiffness"] = 100.0;
  change["clearance"] = 5e-4;  // as it is
  table.change(change);
  EXPECT_EQ(clearance_of(p, "liver", "jaw"), 2e-3);
  all["clearance"][0]["value"] = 3e-3;
  EXPECT_TRUE(table.read_lists(all));
  EXPECT_EQ(clearance_of(p, "liver", "jaw"), 3e-3);
  all["clearance"][0]["link"] = "jaws";
  EXPECT_THROW(table.read_lists(all), ParameterError);
  EXPECT_EQ(clearance_of(p, "liver", "jaw"), 3e-3);
  EXPECT_EQ(clearance_of(p, "liver", "wrist"), 5e-4);
  for (const XmlRpcValue& refused : {XmlRpcValue(5.0), XmlRpcValue("5 mm")}) {
    all["clearance"] = refused;
    EXPECT_THROW(table.read_lists(all), ParameterError);
    EXPECT_EQ(clearance_of(p, "liver", "jaw"), 3e-3) << "a refused number leaves the list";
  }
  change["clearance"] = 7e-4;
  table.change(change);
  EXPECT_EQ(clearance_of(p, "liver", "jaw"), 7e-4);
}

TEST(HapticParameters, ForcesBecomeLengths) {
  HapticProxyParameters p;
  p.stiffness = 200.0;
  p.puncture_force = 3.0;
  p.friction = 0.5;
  ToolParameters tool;
  tool.radius = 0.002;
  tool.freedom = ProxyFreedom::kTrocar;
  const ProxySettings settings = proxy_settings(p, tool);
  EXPECT_EQ(settings.puncture, 0.015);
  EXPECT_EQ(settings.friction, 0.0025);
  p.puncture_force = 0.0;
  EXPECT_FALSE(proxy_settings(p, tool).puncture);
  p.puncture_force = 3.0;
  tool.freedom = ProxyFreedom::kFree;
  EXPECT_FALSE(proxy_settings(p, tool).puncture) << "a free tool pierces nothing";
}

}  // namespace
}  // namespace organ_collision
