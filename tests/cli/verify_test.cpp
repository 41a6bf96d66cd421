// Whether files are as they were written.
#include <fstream>

#include "cli/command_test.hpp"
#include "core/files.hpp"
#include "lobe/study/verify.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

class Verify : public CommandTest {
 protected:
  void change_bit(const std::string& name, std::size_t byte) const {
    std::string bytes = read_text(file(name));
    bytes.at(byte) = static_cast<char>(bytes.at(byte) ^ 4);
    std::ofstream(file(name), std::ios::binary) << bytes;
  }
};

TEST_F(Verify, NamesWhatAFileIs) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "t.h5"});
  const Outcome outcome = run({"verify", "t.h5"});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("t.h5: sound; table, "));
  EXPECT_THAT(outcome.output, HasSubstr("checksum: right"));

  const VerifiedFile table = verify_file(file("t.h5"));
  EXPECT_EQ(table.kind, FileKind::table);
  EXPECT_GE(table.bytes, 8U * 8 * 8 * 9);  // values of 8 x 8 rings and 9 azimuths, and more
}

TEST_F(Verify, FindsAChangedBitAndSaysSoOfAllFiles) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "a.h5"});
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "b.h5"});
  const std::size_t size = std::filesystem::file_size(file("a.h5"));
  // At the beginning, and where the chunks are.
  for (const std::size_t byte : {std::size_t{30}, size / 3, size / 2, size - 20}) {
    SCOPED_TRACE(byte);
    change_bit("a.h5", byte);
    const Outcome outcome = run({"verify", "a.h5", "b.h5"});
    EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::file)) << "byte " << byte << ": " << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("a.h5: damaged; cannot read")) << "byte " << byte;
    EXPECT_THAT(outcome.output, HasSubstr("b.h5: sound")) << "byte " << byte;
    change_bit("a.h5", byte);
  }
}

TEST_F(Verify, SaysThatAFileWithoutItsEndHasNoChecksum) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "a.h5"});
  std::filesystem::resize_file(file("a.h5"), std::filesystem::file_size(file("a.h5")) - 8);
  const Outcome outcome = run({"verify", "a.h5", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("\"has_checksum\": false"));
}

TEST_F(Verify, RefusesWhatIsNoHdf5) {
  std::ofstream(file("text.h5")) << "no HDF5";
  const Outcome outcome = run({"verify", "text.h5"});
  EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::file));
  EXPECT_THAT(outcome.output, HasSubstr("damaged; cannot read"));
}

TEST_F(Verify, DoesNotCallDamagedWhatIsNotThere) {
  const Outcome outcome = run({"verify", "missing.h5"});
  EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::file));
  EXPECT_EQ(outcome.output, "missing.h5: not read; cannot read missing.h5: No such file or directory\n");
}

}  // namespace
}  // namespace lobe::test
