#include "snapshot/snapshot_options.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Arguments = std::vector<std::string>;

SnapshotOptions parse(const Arguments& arguments) { return parse_snapshot_options(arguments); }

std::string refusal(const Arguments& arguments) {
  try {
    parse(arguments);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SnapshotOptions, HaveDefaults) {
  const SnapshotOptions options = parse({});
  EXPECT_EQ(options.topics, Arguments{"organ_collision/markers"});
  EXPECT_EQ(options.output, "snapshot.png");
  EXPECT_EQ(options.frames, 0);
  EXPECT_FALSE(options.target || options.distance || options.help);
}

TEST(SnapshotOptions, AreRead) {
  const SnapshotOptions options = parse({"--topic",
                                         "/a",
                                         "--topic=/b",
                                         "--output",
                                         "x.png",
                                         "--size",
                                         "640x480",
                                         "--up",
                                         "0,2,0",
                                         "--target",
                                         "-0.1,0.2,3e-1",
                                         "--distance",
                                         "0.4",
                                         "--frame",
                                         "world",
                                         "--background",
                                         "#ff8000",
                                         "--after",
                                         "0",
                                         "--frames",
                                         "12",
                                         "--rate",
                                         "25",
                                         "--timeout",
                                         "3.5"});
  EXPECT_EQ(options.topics, (Arguments{"/a", "/b"}));
  EXPECT_EQ(options.output, "x.png");
  EXPECT_EQ(options.width, 640);
  EXPECT_EQ(options.height, 480);
  EXPECT_TRUE(options.up.isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(options.target.value().isApprox(Vector3d(-0.1, 0.2, 0.3)));
  EXPECT_EQ(options.distance, 0.4);
  EXPECT_EQ(options.frame, "world");
  EXPECT_TRUE(options.background.isApprox(Colour(1.0F, 128.0F / 255.0F, 0.0F, 1.0F)));
  EXPECT_EQ(options.after_sec, 0.0);
  EXPECT_EQ(options.frames, 12);
  EXPECT_EQ(options.rate, 25.0);
  EXPECT_EQ(options.timeout_sec, 3.5);
}

TEST(SnapshotOptions, AViewIsADirectionOrTwoAngles) {
  EXPECT_TRUE(parse({"--view", "-3,0,4"}).to_eye.isApprox(Vector3d(-0.6, 0.0, 0.8)));
  EXPECT_TRUE(parse({"--view", "-90,0"}).to_eye.isApprox(Vector3d(0.0, -1.0, 0.0)));
  EXPECT_TRUE(parse({"--view", "0, 30"}).to_eye.isApprox(Vector3d(std::sqrt(0.75), 0.0, 0.5)));
}

TEST(SnapshotOptions, HelpAloneMatters) {
  EXPECT_TRUE(parse({"--size", "nonsense", "--help"}).help);
  EXPECT_TRUE(parse({"-h"}).help);
  for (const char* option :
       {"--topic", "--hide", "--frame", "--after", "--timeout", "--view", "--up", "--target",
        "--distance", "--output", "--size", "--background", "--font", "--frames", "--rate"}) {
    EXPECT_NE(snapshot_usage().find(option), std::string::npos) << option;
  }
}

TEST(SnapshotOptions, IllegalOnesAreRefusedWithTheirValues) {
  EXPECT_EQ(refusal({"--size", "800"}),
            "--size is '800'; must be WIDTHxHEIGHT, each from 16 to 4096");
  EXPECT_EQ(refusal({"--size", "800x5000"}).substr(0, 21), "--size is '800x5000';");
  EXPECT_EQ(refusal({"--size", "80.5x80"}).substr(0, 20), "--size is '80.5x80';");
  EXPECT_EQ(refusal({"--view", "1"}),
            "--view is '1'; must be AZIMUTH,ELEVATION in degrees, or X,Y,Z");
  EXPECT_EQ(refusal({"--view", "0,0,0"}), "--view is '0,0,0'; must be X,Y,Z, not all 0");
  EXPECT_EQ(refusal({"--target", "1,2,x"}), "--target is '1,2,x'; must be X,Y,Z");
  EXPECT_EQ(refusal({"--target", "1,2,3,"}), "--target is '1,2,3,'; must be X,Y,Z");
  EXPECT_EQ(refusal({"--background", "white"}).substr(0, 24), "--background is 'white';");
  EXPECT_EQ(refusal({"--frames", "0"}), "--frames is '0'; must be a number from 1 to 9999");
  EXPECT_EQ(refusal({"--frames", "1.5"}), "--frames is '1.5'; must be a whole number");
  EXPECT_EQ(refusal({"--rate", "nan"}), "--rate is 'nan'; must be a number from 0.01 to 1000");
  EXPECT_EQ(refusal({"--distance", "-1"}).substr(0, 18), "--distance is '-1'");
  EXPECT_EQ(refusal({"stray"}), "unknown argument 'stray'");
  EXPECT_NE(refusal({"--sizes", "1x1"}).find("--sizes"), std::string::npos);
  EXPECT_NE(refusal({"--siz", "20x20"}).find("--siz"), std::string::npos);
  EXPECT_NE(refusal({"--size"}).find("--size"), std::string::npos);
  EXPECT_NE(refusal({"--size", "20x20", "--size", "20x20"}).find("--size"), std::string::npos);
}

TEST(SnapshotOptions, ANamespaceHidesThoseInIt) {
  const SnapshotOptions options = parse({"--hide", "surface", "--hide=names"});
  EXPECT_EQ(options.hidden, (Arguments{"surface", "names"}));
  EXPECT_TRUE(is_hidden("surface", options.hidden));
  EXPECT_TRUE(is_hidden("surface/liver", options.hidden));
  EXPECT_TRUE(is_hidden("names", options.hidden));
  EXPECT_FALSE(is_hidden("surfaces", options.hidden));
  EXPECT_FALSE(is_hidden("touched", options.hidden));
  EXPECT_FALSE(is_hidden("", options.hidden));
}

TEST(SnapshotOptions, PicturesOfASequenceAreNumbered) {
  EXPECT_EQ(numbered_file("frame.png", 1), "frame_0001.png");
  EXPECT_EQ(numbered_file("a.b/frame", 23), "a.b/frame_0023");
  EXPECT_EQ(numbered_file("/tmp/a.b/c.d.png", 9999), "/tmp/a.b/c.d_9999.png");
}

}  // namespace
}  // namespace organ_collision
