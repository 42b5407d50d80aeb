// What stands at the end of a run: the table, the plots, the report.
#pragma once
#include <filesystem>

#include "app/commands.h"

namespace penumbra {

// Prints the table of `folder`'s results and, when `complete`, makes plots and report. They are made from the
// results, so that a failure of theirs is a message and costs the run nothing. Returns exit_cannot_write when
// plots or report could not be written (a full disk), else exit_done.
int after_run(const std::filesystem::path& folder, const Context& context, bool complete);

}  // namespace penumbra
