// Recordings with a pose track as something to play: frame by frame where the bodies were, without simulating. Such a track can be
// looked at by other versions than the one that wrote it, but knows no joints: links are not drawn.
#pragma once

#include "render/player.h"

#include <gyre/track.h>

namespace gyre {

// Plays a track; the time is that since its first frame.
std::unique_ptr<Player> make_track_player(PoseTrack track);

// What a track says of how things look, for a recording that is replayed: names, colours, view.
BodyId find_in_track(const PoseTrack& track, std::span<const SeenBody> bodies, const std::string& name);
void apply_track_colors(const PoseTrack& track, Sight& sight);
std::optional<SceneView> view_of_track(const PoseTrack& track);

}  // namespace gyre
