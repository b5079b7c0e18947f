// The number of values of each stored enum, so that a reader can refuse values that do not exist.
#pragma once

#include "collision/broadphase/proxy.h"
#include "io/codec/bytes.h"
#include "soft/store/soft_store.h"

#include <gyre/defs.h>
#include <gyre/fields.h>
#include <gyre/joints.h>
#include <gyre/fluid.h>
#include <gyre/soft.h>

namespace gyre {

template <>
inline constexpr int kEnumCount<ShapeKind> = kShapeKindCount;
template <>
inline constexpr int kEnumCount<BodyType> = int(BodyType::dynamic) + 1;
template <>
inline constexpr int kEnumCount<JointKind> = kJointKindCount;
template <>
inline constexpr int kEnumCount<JointAxis> = kJointAxisCount;
template <>
inline constexpr int kEnumCount<AxisMotion> = int(AxisMotion::limited) + 1;
template <>
inline constexpr int kEnumCount<PathOrientation> = int(PathOrientation::following) + 1;
template <>
inline constexpr int kEnumCount<SolverKind> = kSolverKindCount;
template <>
inline constexpr int kEnumCount<LcpMethod> = kLcpMethodCount;
template <>
inline constexpr int kEnumCount<CombineRule> = int(CombineRule::product) + 1;
template <>
inline constexpr int kEnumCount<IntegratorKind> = kIntegratorKindCount;
template <>
inline constexpr int kEnumCount<SpringKind> = int(SpringKind::explicit_force) + 1;
template <>
inline constexpr int kEnumCount<TimeStepping> = kTimeSteppingCount;
template <>
inline constexpr int kEnumCount<FieldKind> = kFieldKindCount;
template <>
inline constexpr int kEnumCount<SoftKind> = int(SoftKind::solid) + 1;
template <>
inline constexpr int kEnumCount<SoftIntegrator> = int(SoftIntegrator::visual) + 1;
template <>
inline constexpr int kEnumCount<RopeLinks> = int(RopeLinks::rods) + 1;
template <>
inline constexpr int kEnumCount<ClothLinks> = int(ClothLinks::membrane) + 1;
template <>
inline constexpr int kEnumCount<SolidModel> = int(SolidModel::neo_hookean) + 1;
template <>
inline constexpr int kEnumCount<PressureLaw> = int(PressureLaw::constant) + 1;
template <>
inline constexpr int kEnumCount<SoftGrip> = int(SoftGrip::emerges) + 1;
template <>
inline constexpr int kEnumCount<FluidBoundary> = int(FluidBoundary::no_slip) + 1;
template <>
inline constexpr int kEnumCount<Advection> = int(Advection::semi_lagrangian) + 1;
template <>
inline constexpr int kEnumCount<ProxyMotion> = int(ProxyMotion::moving) + 1;

}  // namespace gyre
