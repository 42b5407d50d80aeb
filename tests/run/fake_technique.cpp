#include "tests/run/fake_technique.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <thread>

namespace penumbra::test {
namespace {

enum class Fault {
  none,
  abort,
  segfault,
  exit,
  hang,
  throw_,
  unsupported,
  late_unsupported,
  nan,
  forget,
  greedy,
  too_large,
  unrepeatable
};
enum class At { setup, build, render, tenth_frame };

struct Params {
  Fault fault = Fault::none;
  At at = At::render;
  float value = 1;
  int sleep_ms = 0;
  bool dynamic = false;
};

const ParamTable<Params>& table() {
  static const ParamTable<Params> t = [] {
    ParamTable<Params> p;
    p.choice("fault", &Params::fault,
             {"none", "abort", "segfault", "exit", "hang", "throw", "unsupported", "late_unsupported", "nan",
              "forget", "greedy", "too_large", "unrepeatable"},
             {"", "", "what goes wrong"});
    p.choice("at", &Params::at, {"setup", "build", "render", "tenth_frame"}, {"", "", "when it goes wrong"});
    p.number("value", &Params::value, 0, 1, {"", "V", "visibility of every pixel"});
    p.integer("sleep_ms", &Params::sleep_ms, 0, 100000, {"ms", "", "time of a frame"});
    p.boolean("dynamic", &Params::dynamic, {"", "", "rebuilt in every frame"});
    return p;
  }();
  return t;
}

class Fake : public Technique {
 public:
  explicit Fake(const Params& p) : p_(p) {}

  std::optional<std::string> supports(const Case&) const override {
    if (p_.fault == Fault::unsupported) return "The fake does not do this case.";
    return std::nullopt;
  }
  void setup(const Case&, gpu::PassRecorder& passes) override {
    passes.host_pass("fake_setup", [&] { fail_if(At::setup); });
  }
  void build(const Case&, gpu::PassRecorder& passes) override {
    passes.host_pass("fake_build", [&] { fail_if(At::build); });
  }
  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    log();
    passes.host_pass("fake_first",
                     [&] { std::this_thread::sleep_for(std::chrono::milliseconds(p_.sleep_ms)); });
    passes.host_pass("fake_second", [&] {
      fail_if(At::render);
      if (++frames_ == 10) fail_if(At::tenth_frame);
      write(in);
    });
  }
  Counters counters() override { return {{"frames", double(frames_)}, {"list", std::vector<double>{1, 2}}}; }
  uint64_t structure_bytes() const override { return 42; }

 private:
  void log() const {
    if (const char* file = std::getenv("PENUMBRA_TEST_LOG"))
      std::ofstream(file, std::ios::app) << p_.value << "\n";
  }
  void write(const RenderInput& in) const {
    float v = p_.value;
    if (p_.fault == Fault::nan) v = std::numeric_limits<float>::quiet_NaN();
    if (p_.fault == Fault::unrepeatable) v = 1.0f / static_cast<float>(frames_);
    const std::size_t pixels = in.host.visibility.size() - (p_.fault == Fault::forget ? 1 : 0);
    for (std::size_t i = 0; i < pixels; ++i) in.host.visibility[i] = v;
    for (uint32_t& word : in.host.mask) word = 0;
  }
  void fail_if(At at) {
    if (at != p_.at) return;
    switch (p_.fault) {
      case Fault::abort:
        std::fputs("the fake's last words\n", stderr);
        std::abort();
      case Fault::segfault:
        std::raise(SIGSEGV);
        break;
      case Fault::exit:
        ::_exit(7);
      case Fault::hang:
        std::fputs("the fake goes to sleep\n", stderr);
        for (;;) ::pause();
      case Fault::throw_:
        throw PointError("the fake cannot finish this point.");
      case Fault::late_unsupported:
        throw UnsupportedError("The fake sees that it cannot do this case.");
      case Fault::too_large:
        hoard_.emplace_back().reserve(hoard_.back().max_size() / 2);
        break;
      case Fault::greedy:
        for (;;) {
          hoard_.emplace_back(std::size_t{64} << 20, '\1');
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
      default:
        break;
    }
  }
  Params p_;
  int frames_ = 0;
  std::vector<std::string> hoard_;
};

}  // namespace

TechniqueInfo fake_technique() {
  TechniqueInfo info;
  info.name = "fake";
  info.title = "A technique that fails on demand";
  info.params = table().infos();
  info.lights = {LightKind::rectangle, LightKind::point};
  info.sampled = true;
  info.residence = Residence::host;
  info.rebuild_each_frame = [](const ParamValues& v) { return table().read(v).dynamic; };
  info.make = [](const ParamValues& v) { return std::make_unique<Fake>(table().read(v)); };
  return info;
}

Registry fake_registry() { return {fake_technique()}; }

}  // namespace penumbra::test
