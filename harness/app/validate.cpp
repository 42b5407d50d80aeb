#include "app/commands.h"

namespace penumbra {

void add_validate(CLI::App& app, Context&) { app.add_subcommand("validate", "")->group(""); }

}  // namespace penumbra
