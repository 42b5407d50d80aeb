#include "techniques/soft_shadow_volume/tables.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "techniques/soft_shadow_volume/shaders/shared.h"

namespace penumbra::soft_shadow_volume {
namespace {

gpu::Image upload(gpu::Device& device, gpu::PassRecorder& passes, uint32_t width, uint32_t height,
                  const std::vector<float>& texels, const char* what) {
  gpu::ImageDesc desc;
  desc.width = width, desc.height = height, desc.format = VK_FORMAT_R32_SFLOAT;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  gpu::Image image(device, desc, what);
  gpu::Buffer staging(device, texels.size() * sizeof(float), gpu::Memory::device, what);
  gpu::upload(passes, "upload_tables", staging, texels.data(), texels.size() * sizeof(float));
  passes.device_pass("upload_tables", [&](gpu::Commands& commands) {
    commands.initialise(image);
    commands.barrier();
    commands.copy_buffer_to_image(staging, image, VK_IMAGE_ASPECT_COLOR_BIT);
  });
  passes.finish();
  return image;
}

// Area of the light from angle 0 to `angle`, -pi to pi.
double swept(uint32_t shape, double angle) {
  if (shape == SHAPE_DISC) return angle / 2;
  // The square from -1 to 1: within an eighth of a turn the triangle below the ray, (1, 0) to (1, tan).
  const double eighth = std::numbers::pi / 4, a = std::abs(angle);
  const double whole = std::floor(a / eighth), rest = a - whole * eighth;
  const bool odd = static_cast<int>(whole) % 2 != 0;
  const double part = odd ? 0.5 - 0.5 * std::tan(eighth - rest) : 0.5 * std::tan(rest);
  return std::copysign(whole * 0.5 + part, angle);
}

}  // namespace

void Tables::make(gpu::Device& device, gpu::PassRecorder& passes, uint32_t shape, int size) {
  const auto n = static_cast<uint32_t>(std::max(size, 1)) + 1;
  std::vector<float> angles, areas;
  const auto share = [&](uint32_t i) { return double(i) / double(n - 1); };
  for (uint32_t i = 0; i < n; ++i) angles.push_back(static_cast<float>(std::atan(share(i))));
  const auto area = [&](uint32_t i) { return swept(shape, (2 * share(i) - 1) * std::numbers::pi); };
  for (uint32_t to = 0; to < n; ++to)
    for (uint32_t from = 0; from < n; ++from) areas.push_back(static_cast<float>(area(to) - area(from)));
  angles_ = upload(device, passes, n, 1, angles, "soft shadow volumes: angles");
  areas_ = upload(device, passes, n, n, areas, "soft shadow volumes: areas");
}

}  // namespace penumbra::soft_shadow_volume
