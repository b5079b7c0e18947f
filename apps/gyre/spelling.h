// A guess at what a misspelt word of the command line was meant to be.
#pragma once

#include <string>
#include <vector>

namespace gyre {

// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other (the optimal string alignment distance).
int edit_distance(const std::string& a, const std::string& b);

// The nearest word of the list, the first of several; empty if none is near: more than a third of the letters, and more than one, differ.
// A word that begins with the misspelt one is near, too.
std::string nearest_word(const std::string& misspelt, const std::vector<std::string>& words);

}  // namespace gyre
