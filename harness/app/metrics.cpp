#include <fmt/format.h>

#include "app/commands.h"
#include "metrics/compare_files.h"

namespace penumbra {
namespace {

void print_text(const FileComparison& c) {
  fmt::print("reference {}\ntest      {}\nsize      {} x {}, {}\n", c.reference, c.test, c.width, c.height,
             c.color ? "colour" : "gray");
  fmt::print("mae       {:.8g}\nrmse      {:.8g}\nmax       {:.8g}\n", c.mae, c.rmse, c.max);
  fmt::print("psnr      {}\n", c.psnr ? fmt::format("{:.6g} dB", *c.psnr) : "none, the images are equal");
  fmt::print("ssim      {:.8g}\nflip      {:.8g}\n", c.ssim, c.flip);
}

}  // namespace

void add_metrics(CLI::App& app, Context&) {
  struct Options {
    std::string reference, test;
    bool as_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("metrics", "Image errors of two EXR or PNG files of any origin");
  sub->add_option("reference", options->reference, "The true image")->required();
  sub->add_option("test", options->test, "The image to judge")->required();
  sub->add_flag("--json", options->as_json, "As a JSON object");
  sub->callback([options] {
    const FileComparison comparison = compare_files(options->reference, options->test);
    if (options->as_json)
      fmt::print("{}", to_json(comparison));
    else
      print_text(comparison);
  });
}

}  // namespace penumbra
