#include "robot_answer.hpp"

#include <exception>
#include <new>
#include <utility>

#include "robot_model.hpp"
#include "ros/tools/robot_reply.hpp"

namespace organ_collision {
namespace {

std::string read_links(const std::string& urdf, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& write) {
  const RobotModel robot(urdf);
  std::vector<LinkDescription> links;
  for (const std::string& name : names) {
    links.push_back(
        robot.link(name, [&](const std::string& what) { write(reading_record(what)); }));
  }
  return links_record(std::move(links));
}

}  // namespace

void answer_with_links(const std::function<std::string()>& urdf,
                       const std::vector<std::string>& links,
                       const std::function<void(const std::string&)>& write) {
  try {
    write(read_links(urdf(), links, write));
  } catch (const std::bad_alloc&) {
    write(refusal_record("there is not enough memory to read it"));
  } catch (const std::exception& error) {
    write(refusal_record(error.what()));
  }
}

}  // namespace organ_collision
