// Embree 3 and 4 under one spelling: the include, and the calls whose signatures differ. No geometry, no
// predicates.
#pragma once
#if PENUMBRA_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace penumbra::embree {

// The scene flag without which a Query's filter is not called.
#if PENUMBRA_EMBREE_VERSION >= 4
inline constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
inline constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

enum class Coherence { coherent, incoherent };

// What a query needs besides the rays: flags, and optionally a filter called on each candidate hit with
// `user` behind the context (see RTCFilterFunctionNArguments::context and user_data()).
class Query {
 public:
  explicit Query(Coherence coherence, RTCFilterFunctionN filter = nullptr, void* user = nullptr) : state_{} {
#if PENUMBRA_EMBREE_VERSION >= 4
    rtcInitRayQueryContext(&state_.context);
    rtcInitOccludedArguments(&occluded_);
    rtcInitIntersectArguments(&intersect_);
    occluded_.context = intersect_.context = &state_.context;
    occluded_.flags = intersect_.flags = static_cast<RTCRayQueryFlags>(
        (coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
        (filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : 0));
    occluded_.filter = intersect_.filter = filter;
#else
    rtcInitIntersectContext(&state_.context);
    state_.context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                            : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    state_.context.filter = filter;
#endif
    state_.user = user;
  }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

#if PENUMBRA_EMBREE_VERSION >= 4
  void occluded(RTCScene s, RTCRay* r) { rtcOccluded1(s, r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay4* r) { rtcOccluded4(valid, s, r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay8* r) { rtcOccluded8(valid, s, r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay16* r) { rtcOccluded16(valid, s, r, &occluded_); }
  void intersect(RTCScene s, RTCRayHit* r) { rtcIntersect1(s, r, &intersect_); }
#else
  void occluded(RTCScene s, RTCRay* r) { rtcOccluded1(s, &state_.context, r); }
  void occluded(const int* valid, RTCScene s, RTCRay4* r) { rtcOccluded4(valid, s, &state_.context, r); }
  void occluded(const int* valid, RTCScene s, RTCRay8* r) { rtcOccluded8(valid, s, &state_.context, r); }
  void occluded(const int* valid, RTCScene s, RTCRay16* r) { rtcOccluded16(valid, s, &state_.context, r); }
  void intersect(RTCScene s, RTCRayHit* r) { rtcIntersect1(s, &state_.context, r); }
#endif

  // The `user` pointer of the query that a filter runs for.
  static void* user_data(const RTCFilterFunctionNArguments* args) {
    return reinterpret_cast<const State*>(args->context)->user;
  }

 private:
#if PENUMBRA_EMBREE_VERSION >= 4
  struct State {
    RTCRayQueryContext context;
    void* user;
  } state_;
  RTCOccludedArguments occluded_;
  RTCIntersectArguments intersect_;
#else
  struct State {
    RTCIntersectContext context;
    void* user;
  } state_;
#endif
};

}  // namespace penumbra::embree
