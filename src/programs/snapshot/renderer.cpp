#include "renderer.hpp"

#include <png.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Automatic framing fills this share of the picture.
constexpr double kFilled = 0.94;
/// [m] The least distance of the eye from the target in automatic framing.
constexpr double kClosest = 1e-3;

double half_height() { return std::tan(0.5 * kFieldOfView); }

// The light comes from above the viewer's left shoulder.
const Vector3d kToLight = Vector3d(-0.35, 0.55, 0.75).normalized();
const Vector3d kHalfway = (kToLight + Vector3d::UnitZ()).normalized();  // halfway to both
constexpr double kAmbient = 0.30;
constexpr double kDiffuse = 0.75;
constexpr double kSpecular = 0.18;
constexpr double kShininess = 30.0;

/// [1] Each pixel has this number of samples along each side.
constexpr int kSamples = 3;
/// [1] The least ratio of the nearest visible depth to the farthest one. What is nearer is cut off.
/// With a larger ratio, the depth buffer is finer.
constexpr double kNearByFar = 1e-3;

/// A vertex as GL reads it, in camera coordinates. Their origin is the eye, so 32 bits are enough
/// even far from the origin of the frame.
struct GlVertex {
  Eigen::Vector3f position;
  Colour colour;
};

using GlTriangle = std::array<GlVertex, 3>;

struct CameraTriangles {
  std::vector<GlTriangle> opaque, transparent;
  /// [m] The nearest and the farthest visible depth.
  double near = std::numeric_limits<double>::infinity(), far = 0.0;
};

GlTriangle seen(const PictureVertex* corners, const Camera& camera) {
  const Vector3d a = camera.to_camera(corners[0].position);
  const Vector3d b = camera.to_camera(corners[1].position);
  const Vector3d c = camera.to_camera(corners[2].position);
  // Both sides of a face are lit. The viewer is at the origin.
  const double side = (b - a).cross(c - a).dot(a) > 0.0 ? -1.0 : 1.0;
  const auto colour = [&](const PictureVertex& vertex) {
    if (vertex.normal.isZero(0.0)) return vertex.colour;
    return lit(vertex.colour, side * (camera.axes.transpose() * vertex.normal));
  };
  return {GlVertex{a.cast<float>(), colour(corners[0])},
          GlVertex{b.cast<float>(), colour(corners[1])},
          GlVertex{c.cast<float>(), colour(corners[2])}};
}

bool is_opaque(const GlTriangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [](const GlVertex& vertex) { return vertex.colour.w() >= 1.0F; });
}

/// The farther triangle comes first. Triangles at the same distance are ordered by their corners,
/// so that the order in the input never matters.
bool is_farther(const GlTriangle& a, const GlTriangle& b) {
  const auto key = [](const GlTriangle& t) {
    const Eigen::Vector3f sum = t[0].position + t[1].position + t[2].position;
    return std::array<float, 4>{-sum.squaredNorm(), sum.x(), sum.y(), sum.z()};
  };
  return key(a) < key(b);
}

CameraTriangles seen(const PictureTriangles& triangles, const Camera& camera) {
  CameraTriangles result;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const GlTriangle triangle = seen(&triangles[i], camera);
    for (const GlVertex& vertex : triangle) {
      const double depth = -vertex.position.z();
      result.near = std::min(result.near, depth);
      result.far = std::max(result.far, depth);
    }
    (is_opaque(triangle) ? result.opaque : result.transparent).push_back(triangle);
  }
  std::sort(result.transparent.begin(), result.transparent.end(), is_farther);
  // The limits leave some space, so that rounding cuts nothing off.
  result.far = std::max(1.01 * result.far, 1e-3);
  result.near = std::clamp(0.99 * result.near, kNearByFar * result.far, 0.98 * result.far);
  return result;
}

void draw(const GlFunctions& gl, const std::vector<GlTriangle>& triangles) {
  if (triangles.empty()) return;
  const GlVertex& first = triangles.front().front();
  gl.VertexPointer(3, GL_FLOAT, sizeof(GlVertex), first.position.data());
  gl.ColorPointer(4, GL_FLOAT, sizeof(GlVertex), first.colour.data());
  gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * triangles.size()));
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw std::runtime_error("cannot write '" + file + "': " + why);
}

}  // namespace

Eigen::Vector3d centre(const PictureTriangles& triangles) {
  Eigen::AlignedBox3d box;
  for (const PictureVertex& vertex : triangles) box.extend(vertex.position);
  return box.center();
}

double framing_distance(const PictureTriangles& triangles, const Eigen::Vector3d& target,
                        const Eigen::Matrix3d& axes, double aspect) {
  const double height = kFilled * half_height();
  double distance = kClosest;
  for (const PictureVertex& vertex : triangles) {
    const Eigen::Vector3d p = axes.transpose() * (vertex.position - target);
    const double needed = std::max(std::abs(p.x()) / aspect, std::abs(p.y())) / height;
    distance = std::max(distance, p.z() + needed);
  }
  return distance;
}

Eigen::Matrix4d projection(double aspect, double near, double far) {
  Eigen::Matrix4d result = Eigen::Matrix4d::Zero();
  result(0, 0) = 1.0 / (aspect * half_height());
  result(1, 1) = 1.0 / half_height();
  result(2, 2) = -(far + near) / (far - near);
  result(2, 3) = -2.0 * far * near / (far - near);
  result(3, 2) = -1.0;
  return result;
}

Colour lit(const Colour& colour, const Vector3d& normal) {
  // Unlike in Lambert's law, some light reaches faces that are turned away, so that no part becomes
  // flat and black.
  const double facing = 0.5 + 0.5 * normal.dot(kToLight);
  const double gloss = std::pow(std::max(0.0, normal.dot(kHalfway)), kShininess);
  const auto light = static_cast<float>(kAmbient + kDiffuse * facing * facing);
  Colour result = colour;
  result.head<3>() = (light * colour.head<3>()).array() + static_cast<float>(kSpecular * gloss);
  return result.cwiseMin(1.0F);
}

void write_png(const std::string& file, const Image& image) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "wb"),
                                                               &std::fclose);
  if (!stream) refuse(file, std::strerror(errno));
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_stdio(&png, stream.get(), 0, image.pixels.data(), 0, nullptr) == 0) {
    refuse(file, png.message);
  }
  if (std::fflush(stream.get()) != 0) refuse(file, std::strerror(errno));
}

Renderer::Renderer(int width, int height)
    : width_(width),
      height_(height),
      context_(GlPlatform::kAuto, GlFramebuffer{kSamples * width, kSamples * height, 24}) {
  const GlFunctions& gl = context_.functions();
  gl.DisableClientState(GL_TEXTURE_COORD_ARRAY);  // which only the pickers use
  gl.EnableClientState(GL_COLOR_ARRAY);
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

Image Renderer::render(const PictureTriangles& triangles, const Camera& camera,
                       const Colour& background) {
  const CameraTriangles visible = seen(triangles, camera);
  context_.make_current();
  const GlFunctions& gl = context_.functions();
  gl.LoadMatrixd(projection(aspect(), visible.near, visible.far).eval().data());
  gl.DepthMask(GL_TRUE);
  gl.ClearColor(background.x(), background.y(), background.z(), 1.0F);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw(gl, visible.opaque);
  gl.DepthMask(GL_FALSE);  // A transparent triangle hides no other one.
  draw(gl, visible.transparent);
  std::vector<std::uint8_t> samples(std::size_t{4} * kSamples * kSamples * width_ * height_);
  gl.ReadPixels(0, 0, kSamples * width_, kSamples * height_, GL_RGBA, GL_UNSIGNED_BYTE,
                samples.data());
  context_.check("a picture");
  return downsampled(samples);
}

/// `samples`: rows from bottom to top, with four bytes (red, green, blue, alpha) a sample.
Image Renderer::downsampled(const std::vector<std::uint8_t>& samples) const {
  Image image{width_, height_, {}};
  image.pixels.reserve(std::size_t{3} * width_ * height_);
  const auto row = [&](int y) { return samples.data() + std::size_t{4} * kSamples * width_ * y; };
  for (int y = kSamples * (height_ - 1); y >= 0; y -= kSamples) {
    for (int x = 0; x < 4 * kSamples * width_; x += 4 * kSamples) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int i = 0; i < kSamples; ++i) {
          for (int j = 0; j < kSamples; ++j) sum += row(y + i)[x + 4 * j + channel];
        }
        constexpr int kCount = kSamples * kSamples;
        image.pixels.push_back(static_cast<std::uint8_t>((sum + kCount / 2) / kCount));
      }
    }
  }
  return image;
}

}  // namespace organ_collision
