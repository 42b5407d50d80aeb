// Parameters of ray_tracing.
#pragma once
#include "technique/params.h"

namespace penumbra {

struct RayTracingParams {
  // `automatic`: high for a static scene, medium for a dynamic one.
  enum class BuildQuality { automatic, low, medium, high, refit };
  // `automatic`: the widest that the processor has vectors for.
  enum class Packet { automatic, one, four, eight, sixteen };
  enum class Order { automatic, light, pixels };
  enum class Coherent { automatic, on, off };

  bool dynamic = false;
  BuildQuality build_quality = BuildQuality::automatic;
  bool robust = false;
  Packet packet = Packet::automatic;
  Order order = Order::automatic;
  Coherent coherent = Coherent::automatic;
};

const ParamTable<RayTracingParams>& ray_tracing_params();

}  // namespace penumbra
