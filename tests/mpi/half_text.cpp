// A rank that is killed in the middle of a text: of a long one MPI sends the beginning, and the rest when it is asked
// for.
#include <fmt/format.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "interface/ranks.hpp"
#include "lobe/core/error.hpp"

int main() {
  using namespace std::chrono_literals;
  ::signal(SIGTERM, SIG_IGN);  // by which mpirun ends the other rank
  const auto ranks = lobe::cli::join_ranks();
  if (ranks == nullptr) return 2;
  if (ranks->rank() == 1) {
    ranks->send(0, std::string(std::size_t{1} << 20, 'x'));
    ::raise(SIGKILL);
  }
  while (!ranks->has_ended(1)) std::this_thread::sleep_for(1ms);
  try {
    const bool has_come = ranks->receive(10s).has_value();
    fmt::print(stderr, "{}\n", has_come ? "all of it has come" : "nothing has come");
  } catch (const lobe::DeviceError& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return 1;
}
