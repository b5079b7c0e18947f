// What moves in a picture: a scene that is simulated or a recording that is played, as one thing. Time begins at 0 and only goes
// on; rewind() begins anew.
#pragma once

#include "formats/import.h"
#include "render/sight.h"
#include "scene/scene.h"

#include <memory>
#include <optional>
#include <string>

namespace gyre {

constexpr const char* kTruncatedNote = "the recording has no end; it is played up to its last whole step";

class Player {
 public:
  virtual ~Player() = default;

  virtual void look(Sight& out) const = 0;
  // True if stress and strain can be read: a recording of poses alone does not know them.
  virtual bool has_readings() const { return true; }
  void read(SoftReading reading) { reading_ = reading; }
  // Where a good picture is taken from, if that is known.
  virtual std::optional<SceneView> view() const = 0;
  // The body of that name; null if there is none or names are not known.
  virtual BodyId find(const std::string& name) const = 0;
  virtual bool has_weight() const = 0;
  virtual bool is_recording() const = 0;
  virtual double time() const = 0;  // s since the beginning
  // False at the end of a recording, and when the state is no longer finite.
  virtual bool step() = 0;
  virtual bool rewind(std::string& error) = 0;

  // What went wrong in step(); empty if nothing did.
  const std::string& problem() const { return problem_; }
  // What the user should know beside that; empty if nothing.
  const std::string& note() const { return note_; }

  // Steps until `seconds` is reached, at most half a step before or after it; false if the end came first.
  bool advance_to(double seconds);
  // Called after each step; false stops advance_to().
  void watch(bool (*watcher)(void* user), void* user) {
    watcher_ = watcher;
    user_ = user;
  }

 protected:
  bool (*watcher_)(void* user) = nullptr;
  void* user_ = nullptr;
  std::string problem_, note_;
  SoftReading reading_ = SoftReading::none;
  double last_step_ = 0;  // s
};

// Opens a scene file or a recording; `look` names a scene file that says how a recording looks (may be empty). Null and an
// error if that fails.
std::unique_ptr<Player> open_player(const std::string& path, const std::string& look,
                                    const ImportOptions& import, int threads, std::string& error);

}  // namespace gyre
