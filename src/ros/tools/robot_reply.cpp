#include "robot_reply.hpp"

#include <cstdint>
#include <cstring>
#include <utility>

namespace organ_collision {
namespace {

enum class Record : std::uint64_t { kReading = 1, kRefusal, kLinks };

struct Malformed : std::runtime_error {
  Malformed() : std::runtime_error("malformed reply") {}
};

class ReplyWriter {
 public:
  std::string bytes() && { return std::move(bytes_); }

  template <typename Value>
  void value(const Value& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  /// A text, or an array of numbers.
  template <typename List>
  void list(const List& list) {
    value<std::uint64_t>(list.size());
    bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  }

 private:
  std::string bytes_;
};

class ReplyReader {
 public:
  explicit ReplyReader(const std::string& bytes) : bytes_(bytes) {}
  bool at_end() const { return next_ == bytes_.size(); }

  template <typename Value>
  void value(Value& value) {
    copy(&value, sizeof(value));
  }
  template <typename List>
  void list(List& list) {
    std::uint64_t size = 0;
    value(size);
    // Checked before the allocation: a malformed size must not exhaust the memory.
    if (size > left() / sizeof(list[0])) throw Malformed();
    list.resize(size);
    copy(list.data(), size * sizeof(list[0]));
  }

 private:
  std::size_t left() const { return bytes_.size() - next_; }
  void copy(void* to, std::size_t size) {
    if (size > left()) throw Malformed();
    if (size > 0) std::memcpy(to, bytes_.data() + next_, size);
    next_ += size;
  }

  const std::string& bytes_;
  std::size_t next_ = 0;
};

// The members of each description in their order, the same for writer and reader.

template <typename Archive>
void transfer(Archive& archive, ShapePose& pose) {
  archive.value(pose.position);
  archive.value(pose.orientation);
}

template <typename Archive>
void transfer(Archive& archive, SphereDescription& sphere) {
  transfer(archive, sphere.pose);
  archive.value(sphere.radius);
}

template <typename Archive>
void transfer(Archive& archive, CylinderDescription& cylinder) {
  transfer(archive, cylinder.pose);
  archive.value(cylinder.radius);
  archive.value(cylinder.length);
}

template <typename Archive>
void transfer(Archive& archive, BoxDescription& box) {
  transfer(archive, box.pose);
  archive.value(box.size);
}

template <typename Archive>
void transfer(Archive& archive, MeshDescription& mesh) {
  archive.list(mesh.file);
  archive.list(mesh.vertices);
  archive.list(mesh.triangles);
}

ShapeDescription empty_shape(std::uint64_t kind) {
  switch (kind) {
    case 0:
      return SphereDescription();
    case 1:
      return CylinderDescription();
    case 2:
      return BoxDescription();
    case 3:
      return MeshDescription();
    default:
      throw Malformed();
  }
}

template <typename Archive>
void transfer(Archive& archive, ShapeDescription& shape) {
  std::uint64_t kind = shape.index();
  archive.value(kind);
  if (kind != shape.index()) shape = empty_shape(kind);
  std::visit([&](auto& described) { transfer(archive, described); }, shape);
}

template <typename Archive, typename Item>
void transfer(Archive& archive, std::vector<Item>& items);

template <typename Archive>
void transfer(Archive& archive, LinkDescription& link) {
  archive.list(link.joint);
  transfer(archive, link.shapes);
}

template <typename Archive, typename Item>
void transfer(Archive& archive, std::vector<Item>& items) {
  std::uint64_t count = items.size();
  archive.value(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i == items.size()) items.emplace_back();
    transfer(archive, items[i]);
  }
}

std::string text_record(Record record, const std::string& text) {
  ReplyWriter writer;
  writer.value(record);
  writer.list(text);
  return std::move(writer).bytes();
}

/// Throws Malformed; what was read before that stays in `reply`.
void take(ReplyReader& reader, RobotReply& reply) {
  Record record{};
  for (reader.value(record); record == Record::kReading; reader.value(record)) {
    reader.list(reply.reading);
  }
  std::string refusal;
  std::vector<LinkDescription> links;
  const bool is_refusal = record == Record::kRefusal;
  if (is_refusal) {
    reader.list(refusal);
  } else if (record == Record::kLinks) {
    transfer(reader, links);
  } else {
    throw Malformed();
  }
  if (!reader.at_end()) throw Malformed();
  if (is_refusal) {
    reply.refusal = std::move(refusal);
  } else {
    reply.links = std::move(links);
  }
}

}  // namespace

std::string reading_record(const std::string& what) { return text_record(Record::kReading, what); }

std::string refusal_record(const std::string& why) { return text_record(Record::kRefusal, why); }

std::string links_record(std::vector<LinkDescription> links) {
  ReplyWriter writer;
  writer.value(Record::kLinks);
  transfer(writer, links);
  return std::move(writer).bytes();
}

RobotReply parse_reply(const std::string& bytes) {
  RobotReply reply;
  ReplyReader reader(bytes);
  try {
    take(reader, reply);
  } catch (const Malformed&) {
    // The reply has neither links nor a refusal.
  }
  return reply;
}

}  // namespace organ_collision
