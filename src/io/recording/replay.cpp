// The player. To go back, it restores the nearest earlier keyframe, which it saved while playing, and plays on from
// there.
#include "io/recording/recording.h"
#include "io/snapshot/state_copy.h"
#include "world/world_access.h"

namespace gyre {

namespace {

// Keyframes of a recording. If they become too many, every second one is removed and the interval doubles.
class Keyframes {
 public:
  static constexpr std::uint64_t kFirstInterval = 16;  // steps
  static constexpr std::size_t kMaxFrames = 128;
  static constexpr std::size_t kMaxBytes = std::size_t(512) << 20;

  // Saves a keyframe if one is due. `position`: steps played.
  void offer(std::uint64_t position, const WorldState& state) {
    if (position % interval_ != 0 || (!frames_.empty() && frames_.back().position >= position)) return;
    frames_.push_back({position, {}});
    frames_.back().state.save(state);
    bytes_ += frames_.back().state.bytes();
    while (frames_.size() > 2 && (frames_.size() > kMaxFrames || bytes_ > kMaxBytes)) thin_out();
  }
  // The last keyframe at or before `position`; null if there is none.
  const StateCopy* find(std::uint64_t position, std::uint64_t& found) const {
    const StateCopy* state = nullptr;
    for (const Frame& frame : frames_) {
      if (frame.position > position) break;
      state = &frame.state;
      found = frame.position;
    }
    return state;
  }

 private:
  struct Frame {
    std::uint64_t position;
    StateCopy state;
  };

  void thin_out() {
    interval_ *= 2;
    std::vector<Frame> remaining;
    bytes_ = 0;
    for (Frame& frame : frames_) {
      if (frame.position % interval_ != 0) continue;
      bytes_ += frame.state.bytes();
      remaining.push_back(std::move(frame));
    }
    frames_ = std::move(remaining);
  }

  std::vector<Frame> frames_;  // by position, ascending
  std::uint64_t interval_ = kFirstInterval;
  std::size_t bytes_ = 0;
};

}  // namespace

struct Replay::Player {
  Recording recording;
  World world;
  std::uint64_t position = 0;
  Keyframes keyframes;

  bool step(bool* matches) {
    if (position >= recording.steps.size()) return false;
    keyframes.offer(position, state_of(world));
    const RecordedStep& step = recording.steps[std::size_t(position)];
    const float seconds = play_commands(recording, step, state_of(world));
    submit(state_of(world), Step{seconds});
    ++position;
    if (matches != nullptr) *matches = has_recorded_hash(step, state_of(world));
    return true;
  }
};

Replay::Replay(std::unique_ptr<Player> player) : player_(std::move(player)) {}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;
Replay& Replay::operator=(Replay&&) noexcept = default;

Result<Replay> Replay::open(std::vector<std::byte> bytes, const WorldDef& def) {
  Result<Recording> recording = open_recording(std::move(bytes));
  if (!recording) return recording.error();
  Result<World> world = make_recorded_world(*recording, def);
  if (!world) return world.error();
  return Replay(std::make_unique<Player>(Player{*std::move(recording), *std::move(world), 0, {}}));
}

World& Replay::world() { return player_->world; }
std::uint64_t Replay::step_count() const { return player_->recording.steps.size(); }
std::uint64_t Replay::position() const { return player_->position; }
bool Replay::truncated() const { return !player_->recording.closed; }
bool Replay::step(bool* matches) { return player_->step(matches); }

Error Replay::seek(std::uint64_t step) {
  Player& player = *player_;
  if (step > step_count()) {
    return make_error(ErrorCode::invalid_argument, "seek: step %llu; the recording has %llu",
                      static_cast<unsigned long long>(step), static_cast<unsigned long long>(step_count()));
  }
  std::uint64_t found = 0;
  const StateCopy* const frame = player.keyframes.find(step, found);
  if (frame != nullptr && (step < player.position || found > player.position)) {
    frame->restore(state_of(player.world));
    player.position = found;
  }
  while (player.position < step) player.step(nullptr);
  return {};
}

}  // namespace gyre
