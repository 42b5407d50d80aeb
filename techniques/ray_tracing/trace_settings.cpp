#include "techniques/ray_tracing/tracer.h"

namespace penumbra::ray_tracing {
namespace {

// Below so many triangles for each light sample the coherence hint is the faster: the more samples a light
// has, the closer lie the rays of a packet (README.md has the figures).
constexpr std::size_t coherent_triangles = 200;

int packet_of(RayTracingParams::Packet packet, int native_packet) {
  switch (packet) {
    case RayTracingParams::Packet::automatic:
      break;
    case RayTracingParams::Packet::one:
      return 1;
    case RayTracingParams::Packet::four:
      return 4;
    case RayTracingParams::Packet::eight:
      return 8;
    case RayTracingParams::Packet::sixteen:
      return 16;
  }
  return native_packet;
}

}  // namespace

TraceSettings trace_settings(const RayTracingParams& params, std::size_t triangles, int light_samples,
                             int native_packet) {
  using Order = RayTracingParams::Order;
  using Coherent = RayTracingParams::Coherent;
  TraceSettings s;
  s.packet = packet_of(params.packet, native_packet);
  s.pixels_in_packet =
      params.order == Order::pixels || (params.order == Order::automatic && light_samples < s.packet);
  const bool coherent = params.coherent == Coherent::on ||
                        (params.coherent == Coherent::automatic &&
                         triangles < coherent_triangles * static_cast<std::size_t>(light_samples));
  s.coherence = coherent ? embree::Coherence::coherent : embree::Coherence::incoherent;
  return s;
}

}  // namespace penumbra::ray_tracing
