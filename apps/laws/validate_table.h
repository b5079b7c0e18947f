// The table of gyre validate: laws measured, as text, JSON or a page.
#pragma once

#include "gyre/validate_options.h"
#include "validation.h"

#include <string>

namespace gyre {

// Runs the laws and prints what they measured. Returns the exit status: failed if a law does not hold.
int validate_table(const ValidateOptions& options);

// A page that needs nothing beside it: a summary, and each row with a bar of its error over its tolerance.
std::string make_validation_page(const Validation& validation);

}  // namespace gyre
