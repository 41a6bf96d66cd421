// A planted fault: a program that replaces a file and looks at nothing that goes wrong meanwhile.
// usage: lobe_careless_writer FILE
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <string>

int main(int, char** words) {
  const std::string text(1000, 'x');
  const std::string temporary = std::string(words[1]) + ".new";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (::write(file, text.data(), text.size()) < 0) std::puts("oh");
  ::close(file);
  std::rename(temporary.c_str(), words[1]);
  return 0;
}
