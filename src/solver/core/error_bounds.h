// Constants of the solver that several rooms share: bounds of the errors that a step removes, fades of the
// second-order bias, and slop of contacts.
#pragma once

namespace gyre {

// Larger errors of a joint count as these.
struct ErrorBounds {
  float point;  // m
  float rotation;  // rad
};

// The bounds keep bodies calm that are joined, or released, far from where the joint wants them.
constexpr ErrorBounds kMaxErrors{0.1f, 0.2f};
// Bounds before contacts are solved. Contacts answer the removal of errors like a load and keep that answer.
// Small errors must be removed there, or a rope would slip round a drum by its compliance. Large errors must
// not: limbs wedged in a heap pressed each other with tons.
constexpr ErrorBounds kErrorsBeforeContacts{0.5e-3f, 5.0e-3f};
constexpr ErrorBounds kNoErrors{0.0f, 0.0f};
// rad. Larger violations of an angular limit count as this. They are removed more slowly than other errors,
// because the axis of the limit rotates meanwhile and part of the removal speed stays.
constexpr float kMaxLimitError = 0.1f;

// rad. Bodies that rotate less than kMinBiasAngle in a sub-step get no second-order bias. Beyond
// kMaxBiasAngle the bias fades: the end of a whip then loses energy instead of gaining it.
constexpr float kMinBiasAngle = 1.0e-4f, kMaxBiasAngle = 0.3f;
// rad. Bias that is faded out, or that two solves do not find, opens the joint anew in each sub-step. Joints
// whose bodies rotate further than this remove errors faster, up to the whole error in one sub-step.
constexpr float kFastErrorAngle = 0.15f;
// rad. Bodies that rotate less than this in a half step may keep the speed that removed errors until the next
// half step computes their bias.
constexpr float kSlowRotation = 0.05f;

// Energy that passive joints may add in a sub-step, as a share of the kinetic energy before, until the energy
// limiter removes all of it. Beyond the second order, the bias adds and removes less than this in a smooth
// swing. Before bodies have moved the share may be larger, because the speed from the bias disappears after
// the move.
constexpr float kMaxEnergyGain = 1.0e-2f, kMaxEnergyGainAhead = 1.0f;

// Compliance of a motor without a frequency of its own that is solved with the equations of its articulation,
// as a share of the compliance of the free axis. It is ten times that of the equations, so motors in conflict
// do not break them.
constexpr float kMotorCompliance = 1.0e-3f;

// The twist limits of a cone are inactive where 1 + cos(swing) is below this, from 143 degrees on. A limb
// that points straight back has no twist, and near there the twist jumps.
constexpr float kMinTwistReported = 0.2f;
// rad. Smaller swing limits of a cone count as this.
constexpr float kMinSwingLimit = 1.0e-3f;
// Gap of a limit that cannot be reached.
constexpr float kUnreachable = 1.0e9f;  // rad

// Tension in a joint is left alone up to this value of h^2 k / I. Semi-implicit Euler is stable up to 4.
constexpr float kGeometricStiffnessThreshold = 1.0f;

// Penetration to which the springs of contacts draw loaded points, as a share of the contact's size: loaded
// points then stay in touch.
constexpr double kSpringSlop = 4.0e-4;
// Penetration that pushout leaves: as a multiple of kSpringSlop, and as a share of the size.
constexpr double kPushoutSlopFactor = 1.5, kPushoutSlop = 6.0e-4;
// Share of the penetration beyond the slop that pushout removes in a step.
constexpr double kPushoutShare = 0.4;

}  // namespace gyre
