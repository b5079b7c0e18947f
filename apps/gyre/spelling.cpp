// A guess at misspelt words. See spelling.h.
#include "spelling.h"

#include <algorithm>

namespace gyre {

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = int(i);
  for (std::size_t k = 0; k <= b.size(); ++k) d[0][k] = int(k);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t k = 1; k <= b.size(); ++k) {
      d[i][k] =
          std::min({d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1)});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        d[i][k] = std::min(d[i][k], d[i - 2][k - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string nearest_word(const std::string& misspelt, const std::vector<std::string>& words) {
  constexpr std::size_t kLongest = 64;  // letters; longer texts are no misspelt word
  if (misspelt.empty() || misspelt.size() > kLongest) return {};
  std::string best;
  int least = std::max(1, int(misspelt.size()) / 3) + 1;
  for (const std::string& word : words) {
    const bool begins = misspelt.size() >= 3 && word.rfind(misspelt, 0) == 0;
    const int distance = begins ? 1 : edit_distance(misspelt, word);
    if (distance >= least) continue;
    least = distance;
    best = word;
  }
  return best;
}

}  // namespace gyre
