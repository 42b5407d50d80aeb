#include "techniques/depth_complexity_sampling/kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/depth_complexity_sampling/kernel.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set
#include <hwy/highway.h>

#include "techniques/depth_complexity_sampling/counters-inl.h"
#include "techniques/depth_complexity_sampling/walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

void find_candidates_here(const Occluders& scene, const ViewPoint* points, std::size_t count,
                          Scratch& scratch) {
  scene.light->grid ? walk<true>(scene, points, count, scratch) : walk<false>(scene, points, count, scratch);
}

const char* name_of_target() { return hwy::TargetName(HWY_TARGET); }
int lanes_of_target() { return static_cast<int>(hn::Lanes(Floats())); }

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::depth_complexity {

HWY_EXPORT(find_candidates_here);
HWY_EXPORT(name_of_target);
HWY_EXPORT(lanes_of_target);

void find_candidates(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(find_candidates_here)(scene, points, count, scratch);
}
std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(name_of_target)(); }
int vector_lanes() { return HWY_DYNAMIC_DISPATCH(lanes_of_target)(); }

}  // namespace penumbra::depth_complexity
#endif
