// How many bytes a moving body and frame take, and how long it takes, with several ways to code the same differences between
// predicted and real poses: the Rice code of pose tracks, DEFLATE, Zstandard, and an adaptive binary range coder. For
// docs/decisions/track-coding.md.
// Usage: track_coding [SCENE...]   without a scene: a thousand boxes that fall into a pit
#include "io/track/pose_codec.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <gyre/world.h>

#include <zlib.h>
#ifdef GYRE_HAVE_ZSTD
#include <zstd.h>
#endif

#include <array>
#include <cstdio>
#include <ctime>
#include <functional>

namespace {

using namespace gyre;

constexpr int kFrames = 600;
constexpr int kGroup = 64;  // frames between keyframes
constexpr PoseSteps kSteps;

// The six differences of one body in one frame, and how large those before were.
struct Differences {
  std::uint32_t body = 0;
  std::array<std::int64_t, 6> values{};
  bool other_largest = false;
};
using Frames = std::vector<std::vector<Differences>>;

// Differences as the track forms them, histories anew at each keyframe.
Frames differences_of(const World& world, const std::function<void()>& step) {
  Frames frames;
  std::vector<PoseHistory> histories;
  for (int i = 0; i < kFrames; ++i, step()) {
    const BodyColumns bodies = world.bodies();
    const bool key = i % kGroup == 0;
    histories.resize(bodies.ids.size());
    frames.emplace_back();
    for (std::size_t b = 0; b < bodies.ids.size(); ++b) {
      RoundedPose pose = round_pose(bodies.poses[b], kSteps);
      if (key) histories[b] = begin_history(pose);
      if (key || !world.is_awake(bodies.ids[b])) continue;
      const RoundedPose expected = predict(histories[b], kSteps);
      Differences found;
      found.body = std::uint32_t(b);
      found.other_largest = pose.largest != expected.largest;
      for (int axis = 0; axis < 3; ++axis)
        found.values[std::size_t(axis)] = pose.position[axis] - expected.position[axis];
      const std::int64_t sign = expected.orientation[pose.largest] < 0 ? -1 : 1;
      std::size_t component = 3;
      for (int part = 0; part < 4; ++part) {
        if (part != pose.largest)
          found.values[component++] = pose.orientation[part] - sign * expected.orientation[part];
      }
      advance(histories[b], pose, kSteps);
      frames.back().push_back(found);
    }
  }
  return frames;
}

std::size_t rice_bytes(const Frames& frames) {
  std::size_t bytes = 0;
  std::vector<PoseHistory> histories;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % kGroup == 0) histories.clear();
    BitWriter bits;
    for (const Differences& body : frames[i]) {
      if (histories.size() <= body.body) histories.resize(body.body + 1);
      for (std::size_t c = 0; c < 6; ++c) {
        std::int64_t value = body.values[c];
        code_difference(bits, value, histories[body.body].sizes[c]);
      }
      bits.code_bits(body.other_largest, 1);
      if (body.other_largest) bits.code_bits(0, 2);
    }
    bytes += bits.take().size();
  }
  return bytes;
}

// Folded differences of a group of frames, component by component, low bytes and high bytes apart.
std::vector<std::vector<unsigned char>> byte_planes(const Frames& frames) {
  std::vector<std::vector<unsigned char>> groups;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % kGroup == 0) groups.emplace_back();
    for (std::size_t c = 0; c < 6; ++c) {
      for (const int shift : {0, 8}) {
        for (const Differences& body : frames[i])
          groups.back().push_back(static_cast<unsigned char>(fold_sign(body.values[c]) >> shift & 0xff));
      }
    }
  }
  return groups;
}

std::size_t deflate_bytes(const std::vector<std::vector<unsigned char>>& groups, int level) {
  std::size_t bytes = 0;
  for (const auto& group : groups) {
    uLongf size = compressBound(uLong(group.size()));
    std::vector<unsigned char> out(size);
    compress2(out.data(), &size, group.data(), uLong(group.size()), level);
    bytes += size;
  }
  return bytes;
}

#ifdef GYRE_HAVE_ZSTD
std::size_t zstd_bytes(const std::vector<std::vector<unsigned char>>& groups, int level) {
  std::size_t bytes = 0;
  for (const auto& group : groups) {
    std::vector<unsigned char> out(ZSTD_compressBound(group.size()));
    bytes += ZSTD_compress(out.data(), out.size(), group.data(), group.size(), level);
  }
  return bytes;
}
#endif

// A binary range coder with carry (G. N. N. Martin, "Range encoding", 1979); chances adapt at two speeds.
class RangeCoder {
 public:
  struct Chance {
    std::uint16_t fast = 32768, slow = 32768;
  };
  void code(Chance& chance, bool bit) {
    const auto mean = std::uint32_t(chance.fast + chance.slow) >> 5;  // 12 bits
    const std::uint32_t split = (range_ >> 12) * (mean < 16 ? 16 : mean > 4080 ? 4080 : mean);
    if (bit) {
      low_ += split;
      range_ -= split;
      chance.fast = std::uint16_t(chance.fast - (chance.fast >> 4));
      chance.slow = std::uint16_t(chance.slow - (chance.slow >> 7));
    } else {
      range_ = split;
      chance.fast = std::uint16_t(chance.fast + ((65535 - chance.fast) >> 4));
      chance.slow = std::uint16_t(chance.slow + ((65535 - chance.slow) >> 7));
    }
    while (range_ < (1u << 24)) range_ <<= 8, shift_low();
  }
  void code_plain(std::uint64_t bits, int count) {
    while (count-- > 0) {
      range_ >>= 1;
      if (bits >> count & 1) low_ += range_;
      while (range_ < (1u << 24)) range_ <<= 8, shift_low();
    }
  }
  std::size_t finish() {
    for (int i = 0; i < 5; ++i) shift_low();
    return count_;
  }

 private:
  void shift_low() {
    ++count_;  // a byte goes out now or with the next carry: only their number matters here
    low_ = (low_ & 0x00ffffffu) << 8;
  }
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::size_t count_ = 0;
};

int size_class(std::int64_t size) {
  return size < 3 ? int(size) : std::min(int(std::bit_width(std::uint64_t(size))) + 1, 13);
}

// Contexts: the component, the sizes of the same body's last differences, those of the components before.
std::size_t range_coder_bytes(const Frames& frames) {
  struct Context {
    RangeCoder::Chance length[64], sign, top[64][3];
  };
  std::vector<Context> contexts;
  std::vector<std::array<std::int64_t, 6>> sizes;
  RangeCoder::Chance largest;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % kGroup == 0) {
      contexts.assign(6 * 14 * 14, {});
      sizes.clear();
      largest = {};
    }
    RangeCoder coder;
    for (const Differences& body : frames[i]) {
      if (sizes.size() <= body.body) sizes.resize(body.body + 1);
      std::int64_t neighbours = 0;
      for (std::size_t c = 0; c < 6; ++c) {
        const std::int64_t value = body.values[c];
        const auto size = std::uint64_t(value < 0 ? -value : value);
        const int near = size_class(c % 3 == 0 ? sizes[body.body][c] >> 4 : neighbours / std::int64_t(c % 3));
        Context& context =
            contexts[(c * 14 + std::size_t(near)) * 14 + std::size_t(size_class(sizes[body.body][c] >> 4))];
        const int length = int(std::bit_width(size));
        for (int bit = 0; bit < length; ++bit) coder.code(context.length[bit], true);
        coder.code(context.length[length], false);
        if (length > 0) coder.code(context.sign, value < 0);
        const bool second = length > 1 && (size >> (length - 2) & 1);
        if (length > 1) coder.code(context.top[length][0], second);
        if (length > 2) coder.code(context.top[length][1 + second], size >> (length - 3) & 1);
        if (length > 3) coder.code_plain(size & ((std::uint64_t(1) << (length - 3)) - 1), length - 3);
        neighbours = c % 3 == 2 ? 0 : neighbours + std::int64_t(size);
        sizes[body.body][c] += (16 * std::int64_t(size) - sizes[body.body][c] + 1) >> 1;
      }
      coder.code(largest, body.other_largest);
      if (body.other_largest) coder.code_plain(0, 2);
    }
    bytes += coder.finish();
  }
  return bytes;
}

void report(const char* name, const Frames& frames) {
  std::size_t moving = 0;
  for (const auto& frame : frames) moving += frame.size();
  std::printf("%s: %zu moving bodies in %d frames\n", name, moving, kFrames);
  const auto line = [&](const char* way, const std::function<std::size_t()>& code) {
    const std::clock_t begin = std::clock();
    const std::size_t bytes = code();
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("  %-34s %6.3f bytes  %7.1f ns a body, one core\n", way, double(bytes) / double(moving),
                1e9 * seconds / double(moving));
  };
  line("Rice code", [&] { return rice_bytes(frames); });
  line("adaptive range coder", [&] { return range_coder_bytes(frames); });
  line("DEFLATE 6 of 64 frames", [&] { return deflate_bytes(byte_planes(frames), 6); });
  line("DEFLATE 9 of 64 frames", [&] { return deflate_bytes(byte_planes(frames), 9); });
#ifdef GYRE_HAVE_ZSTD
  line("Zstandard 3 of 64 frames", [&] { return zstd_bytes(byte_planes(frames), 3); });
  line("Zstandard 19 of 64 frames", [&] { return zstd_bytes(byte_planes(frames), 19); });
#endif
}

void report_pile() {
  World world = *World::create({.threads = 0});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  const Vec3 halves[] = {{0.5f, 4, 7}, {7, 4, 0.5f}};
  for (const double side : {-6.5, 6.5}) {
    world.add_body({.type = BodyType::fixed, .pose = {{side, 4, 0}, {}}}, {.geometry = Box{halves[0]}});
    world.add_body({.type = BodyType::fixed, .pose = {{0, 4, side}, {}}}, {.geometry = Box{halves[1]}});
  }
  for (int i = 0; i < 1000; ++i) {
    const int x = i % 7, z = i / 7 % 7, y = i / 49;
    const Vec3 axis{float(i * 37 % 11) - 5, float(i * 53 % 13) - 6, float(i * 71 % 17) - 8};
    world.add_body(
        {.pose = {{1.6 * (x - 3) + 0.01 * (i % 19), 1.5 + 1.6 * y, 1.6 * (z - 3) + 0.01 * (i % 23)},
                  from_axis_angle(axis, 0.1f * float(i % 30))}},
        {.geometry = Box{}});
  }
  report("a thousand boxes into a pit", differences_of(world, [&] { world.step(1.0f / 60); }));
}

bool report_scene(const char* path) {
  SceneResult<Scene> scene = load_scene(path);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().text().c_str());
    return false;
  }
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), path, 0);
  if (!runner) {
    std::fprintf(stderr, "%s\n", runner.error().text().c_str());
    return false;
  }
  report(path, differences_of(runner->world(), [&] { runner->step(); }));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 1) report_pile();
  bool good = true;
  for (int i = 1; i < argc; ++i) good = report_scene(argv[i]) && good;
  return good ? 0 : 1;
}
