// Results for papers: LaTeX text, each with a comment that says which packages it needs.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "run/results.h"

namespace penumbra::run {

// A booktabs table: a row for each point, the parameters that take several values, median frame time with its
// 95 % interval, errors.
std::string latex_table(const RecordSource& source);
// pgfplots: for each scene an axis of error (rmse against the converged reference; where there is none, mae
// against the matched one) over frame time, both logarithmic, with a mark for each technique.
std::string pgfplots_figure(const RecordSource& source);
// The same as a document that compiles as it is.
std::string latex_document(const std::string& fragment);
// Text as LaTeX prints it: special characters escaped.
std::string latex_text(const std::string& text);

// What a paper says of where its figures come from: sentences, and a BibTeX entry of the program.
std::string provenance_text(const nlohmann::json& run, const RecordSource& source);

}  // namespace penumbra::run
