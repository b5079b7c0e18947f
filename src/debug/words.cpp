#include "debug/words.h"

#include <cstdarg>
#include <cstdio>

namespace gyre {

namespace {

// Neighbours and joints beyond this number are counted, not named.
constexpr std::size_t kMaxNamed = 4;

class Sentences {
 public:
  Sentences(Explanation& out, const BodyNames& names) : out_(out), names_(names) {}

#if defined(__GNUC__)
  __attribute__((format(printf, 2, 3)))
#endif
  void
  add(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int written = std::vsnprintf(out_.words + used_, sizeof out_.words - used_, format, arguments);
    va_end(arguments);
    if (written > 0) used_ += std::size_t(written);
    if (used_ >= sizeof out_.words) used_ = sizeof out_.words - 1;
  }
  void name(BodyId body) {
    const char* const own_name = names_.of != nullptr ? names_.of(names_.user, body) : nullptr;
    if (own_name != nullptr) {
      add("%s", own_name);
    } else {
      add("body %u", body.index);
    }
  }
  // The separator in a list.
  void separate(std::size_t i, std::size_t count) {
    add("%s", i == 0 ? "" : (i + 1 == count ? " and " : ", "));
  }

  void reason(BodyId body);
  void rest();
  void island();
  void touching();
  void joints();

 private:
  void name_cause();

  Explanation& out_;
  const BodyNames& names_;
  std::size_t used_ = 0;
};

// The activity of a body that keeps its island awake.
const char* doing(AwakeReason reason) {
  switch (reason) {
    case AwakeReason::may_not_sleep:
      return "which may not sleep";
    case AwakeReason::unsupported:
      return "which nothing holds up";
    case AwakeReason::moving:
      return "which still moves";
    case AwakeReason::kinematic:
      return "which the program moves";
    case AwakeReason::settling:
      return "which has been still for a shorter time";
    default:
      return "which is awake";
  }
}

void Sentences::name_cause() {
  name(out_.cause);
  add(", %s", doing(out_.cause_reason));
}

void Sentences::reason(BodyId body) {
  name(body);
  switch (out_.reason) {
    case AwakeReason::none:
      add(" does not exist in this world.");
      return;
    case AwakeReason::fixed:
      add(" is fixed: it never moves.");
      return;
    case AwakeReason::kinematic:
      add(" is kinematic: the program moves it, and it never sleeps.");
      return;
    case AwakeReason::frozen:
      add(" is frozen: its position or velocity was no longer a finite number, so it is kept where it last "
          "was.");
      return;
    case AwakeReason::disabled:
      add(" is disabled: it takes no part in the simulation until it is enabled again.");
      return;
    case AwakeReason::asleep:
      add(" is asleep.");
      return;
    case AwakeReason::sleeping_off:
      add(" is awake because sleeping is switched off in this world.");
      return;
    case AwakeReason::may_not_sleep:
      add(" is awake because its definition says that it may not sleep.");
      return;
    case AwakeReason::unsupported:
      add(" is awake because nothing touches it and it hangs on no joint: it flies or falls.");
      return;
    case AwakeReason::moving:
      add(" is awake because it moves.");
      return;
    case AwakeReason::settling:
      add(" is awake because it has not been still for long enough.");
      return;
    case AwakeReason::neighbor:
      add(" is awake because its island waits for ");
      break;
    case AwakeReason::moving_support:
      add(" is awake because its island lies or hangs on ");
      break;
  }
  name_cause();
  add(".");
}

void Sentences::rest() {
  if (out_.island_bodies == 0 || out_.reason == AwakeReason::asleep) return;
  const bool still = out_.speed <= out_.rest_speed;
  add(" Its speed is %.3g m/s, %s the %.3g m/s that count as still", double(out_.speed),
      still ? "below" : "above", double(out_.rest_speed));
  if (out_.still_seconds > 0.0f) {
    add("; it has been still for %.2f of the %.2g s that are needed", double(out_.still_seconds),
        double(out_.seconds_to_sleep));
  }
  add(".");
}

void Sentences::island() {
  if (out_.island_bodies == 0) return;
  if (out_.island_bodies == 1) {
    add(" It is an island of its own.");
  } else {
    add(" It is in the island of ");
    name(out_.island);
    add(", of %d bodies.", out_.island_bodies);
  }
}

void Sentences::touching() {
  if (out_.touching.empty()) return;
  add(" It touches ");
  const std::size_t all = out_.touching.size();
  const std::size_t count = all > kMaxNamed ? kMaxNamed : all;
  const std::size_t items = all > kMaxNamed ? count + 1 : count;
  for (std::size_t i = 0; i < count; ++i) {
    const TouchingBody& other = out_.touching[i];
    separate(i, items);
    name(other.body);
    add(" (%d point%s, %.3g N", other.points, other.points == 1 ? "" : "s", double(other.force));
    if (other.depth > 0.0f) add(", %.2g mm deep", 1000.0 * double(other.depth));
    add("%s)", other.sliding ? ", sliding" : "");
  }
  if (all > count) add(" and %zu more", all - count);
  add(".");
}

void Sentences::joints() {
  if (out_.joints.empty()) return;
  add(" It is pulled by ");
  const std::size_t all = out_.joints.size();
  const std::size_t count = all > kMaxNamed ? kMaxNamed : all;
  const std::size_t items = all > kMaxNamed ? count + 1 : count;
  for (std::size_t i = 0; i < count; ++i) {
    const PullingJoint& joint = out_.joints[i];
    separate(i, items);
    add("%s joint %u to ", to_string(joint.kind), joint.joint.index);
    if (joint.other) {
      name(joint.other);
    } else {
      add("the world");
    }
    add(" (%.3g N, %.3g N m)", double(joint.force), double(joint.torque));
  }
  if (all > count) add(" and %zu more", all - count);
  add(".");
}

}  // namespace

void write_words(Explanation& out, BodyId body, const BodyNames& names) {
  Sentences sentences(out, names);
  sentences.reason(body);
  sentences.rest();
  sentences.island();
  sentences.touching();
  sentences.joints();
}

}  // namespace gyre
