#include "offline/shape_folder.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"
#include "temporary_folder.hpp"

namespace organ_collision {
namespace {

using Paths = std::vector<std::string>;

TEST(ShapeFolder, has_the_obj_files_in_natural_order) {
  const TemporaryFolder folder;
  const std::string ten = folder.write("step_10.obj", ""), two = folder.write("step_2.obj", ""),
                    one = folder.write("step_01.OBJ", "");
  EXPECT_EQ(shape_files(folder.path()), (Paths{one, two, ten}));
}

TEST(ShapeFolder, leaves_out_other_files) {
  const TemporaryFolder folder;
  for (const char* name : {"motions.csv", "obj", ".obj", ".step_1.obj", "step_1.obj~", "a.mtl"}) {
    folder.write(name, "");
  }
  const std::string shape = folder.write("a.b.obj", "");
  EXPECT_EQ(shape_files(folder.path()), Paths{shape});
}

TEST(ShapeFolder, refuses_what_has_no_shapes) {
  const TemporaryFolder folder;
  EXPECT_EQ(input_error([&] { shape_files(folder.path()); }),
            folder.path() + ": the folder has no OBJ file; must have at least one");
  EXPECT_EQ(input_error([] { shape_files("/nowhere"); }),
            "/nowhere: cannot be read: No such file or directory");
  const std::string file = folder.write("a.obj", "");
  EXPECT_EQ(input_error([&] { shape_files(file); }), file + ": cannot be read: Not a directory");
}

}  // namespace
}  // namespace organ_collision
