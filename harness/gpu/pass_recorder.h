// The per-pass clock. Techniques name their passes and say what to record; only the recorder times, so that
// no technique measures itself.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"

namespace penumbra::gpu {

struct PassTime {
  std::string name;
  double ms = 0;
};

class PassRecorder {
 public:
  explicit PassRecorder(Device& device);
  ~PassRecorder();
  PassRecorder(const PassRecorder&) = delete;
  PassRecorder& operator=(const PassRecorder&) = delete;

  Device& device() const;

  // One pass on the device; a full barrier follows it. `record` must not wait for the device. With the
  // submit-and-fence clock the pass runs at once; with timestamps it runs at the next host_pass(), finish()
  // or take_times().
  void device_pass(std::string_view name, const std::function<void(Commands&)>& record);
  // Host work, timed by the host's clock, after everything recorded so far has finished.
  void host_pass(std::string_view name, const std::function<void()>& work);
  // Waits for all recorded passes. After it, mapped buffers and read-backs hold their results.
  void finish();
  // Forgets the passes that are recorded but have not run, and all times: for whoever catches an error that
  // left a technique between its passes. What they would have used may be gone already.
  void abandon();

  // Passes since the last take_times(), in first-use order; passes of one name are added up.
  std::vector<PassTime> take_times();
  // Called with each pass's name as it begins: the supervisor's "last pass reached".
  std::function<void(std::string_view)> on_pass;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Copies between host and device outside any technique pass (set-up, results): staged where memory is not
// mapped.
void upload(PassRecorder& passes, std::string_view pass, const Buffer& to, const void* data,
            std::size_t bytes);
void download(PassRecorder& passes, std::string_view pass, const Buffer& from, void* data, std::size_t bytes);

}  // namespace penumbra::gpu
