// The table of parameters of haptic_proxy.
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

INSTANTIATE_TYPED_TEST_SUITE_P(HapticProxy, ParameterTableTest, HapticProxyParameters);

namespace {

XmlRpcValue kept(const XmlRpcValue& organ, const XmlRpcValue& side) {
  XmlRpcValue entry;
  entry["organ"] = organ;
  entry["side"] = side;
  return entry;
}

TEST(HapticParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  EXPECT_EQ(refusal_of<HapticProxyParameters>("frame", "/"),
            "~frame is '/'; must be the name of a TF frame");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("clearance", -1.5),
            "~clearance is '-1.5'; must be a number, 1e-05 to 0.1, or a list of groups of organ, "
            "link and value");
  expect_words(refusal_of<HapticProxyParameters>("clearance", 9e-6), {"1e-05 to 0.1"});
  expect_words(refusal_of<HapticProxyParameters>("clearance", kept("liver", "inside")),
               {"~clearance is the group", "1e-05 to 0.1, or a list of groups"});
  EXPECT_EQ(refusal_of<HapticProxyParameters>("max_force", 0),
            "~max_force is '0'; must be a number, above 0, up to 10000, or .inf");
  XmlRpcValue keep;
  EXPECT_EQ(refusal_of<HapticProxyParameters>("keep", "inside"),
            "~keep is the text 'inside'; must be a list of groups of organ and side");
  keep[0] = kept("colon", "left");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/side is 'left'"});
  const std::string legal = "must be one of outside, inside, either";
  keep[0] = kept("colon", 1);
  expect_words(refusal_of<HapticProxyParameters>("keep", keep),
               {"~keep[0]/side is the number '1'; " + legal});
  keep[0] = XmlRpcValue();
  keep[0]["name"] = "colon";
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/name is no parameter"});
  XmlRpcValue no_side;
  no_side[0]["organ"] = "colon";
  expect_words(refusal_of<HapticProxyParameters>("keep", no_side),
               {"~keep[0]/side is missing; " + legal});
  keep[0] = kept("", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/organ is ''"});
  keep[0] = keep[1] = kept("colon", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[1]/organ", "unique"});
  XmlRpcValue tools;
  tools[0] = tools[1] = legal_parameters<HapticProxyParameters>()["tools"][0];
  tools[1]["name"] = "left_hook";  // Its topics would have the same names.
  expect_words(refusal_of<HapticProxyParameters>("tools", tools),
               {"~tools has 'left hook' and 'left_hook'"});
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
