#include "report/report.h"

#include <fmt/format.h>

#include <memory>

#include "app/commands.h"

namespace penumbra {

void add_report(CLI::App& app, Context& context) {
  struct Options {
    std::string run, out;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("report", "Write a run's report: a folder that opens in a browser from disk");
  sub->add_option("RUN", options->run, "Folder of results")->required();
  sub->add_option("-o,--out", options->out, "Where the report goes (default: RUN/report)");
  sub->callback([options, &context] {
    const ReportSummary summary = write_report(options->run, options->out);
    for (const std::string& warning : summary.warnings)
      fmt::print(stderr, "penumbra: warning: {}\n", warning);
    fmt::print("{}\n", summary.index.string());
    context.exit_code = exit_done;
  });
}

}  // namespace penumbra
