#include "app/commands.h"

namespace penumbra {

void add_describe(CLI::App& app, Context&) { app.add_subcommand("describe", "")->group(""); }

}  // namespace penumbra
