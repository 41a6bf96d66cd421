// Planted faults that a sanitizer has to report.
// usage: lobe_planted_fault overflow|signed|race
#include <climits>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

int main(int count, char** words) {
  const std::string fault = count > 1 ? words[1] : "";
  int shared = 0;
  if (fault == "overflow") {
    const std::vector<int> values(4, 1);
    const int* first = values.data();
    shared = first[count + 2];  // 4 is the first that is not there
  } else if (fault == "signed") {
    shared = INT_MAX - 2 + count;
    shared += count;
  } else if (fault == "race") {
    std::thread other([&] { ++shared; });
    ++shared;
    other.join();
  }
  std::printf("%d\n", shared);
  return 0;
}
