// Texts that may have been cut within their last number.
#include "formats/text_end.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/measured_files.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::string remark_on(const std::string& text) {
  return remark_on_end(FileBytes::copy("a.csv", text));
}

const std::string kRows = "in,out,f\n0,1,0.125\n0,2,0.250\n0,3,0.375\n0,4,0.500\n0,5,0.625\n";

TEST(TextEnd, OfALineThatIsEndedSaysNothing) {
  for (const std::string& text :
       {kRows, kRows + "0,6,0.7\n", kRows + "0,6,0.7\r\n", kRows + "0,6,0.7 ", kRows + "0,6,0.7,", kRows + "# the end",
        std::string("0.125"), std::string(), std::string("a\0b\n1", 5)}) {
    EXPECT_EQ(remark_on(text), "") << text;
  }
}

TEST(TextEnd, InANumberIsRemarked) {
  for (const char* text : {"1,2\n3,45", "0.5\n0.25\n0.125\n0.5\n0.1", "0,1.5e-3\n0,2", "a b\r\n1 2"}) {
    EXPECT_THAT(remark_on(text), HasSubstr("nobody can tell whether its last number")) << text;
  }
}

TEST(TextEnd, WithFewerDecimalsThanAllNumbersAboveIsRefused) {
  EXPECT_THAT(remark_on(kRows + "0,6,0.750"), HasSubstr("last number, 0.750,"));
  for (const char* cut : {"0,6,0.75", "0,6,0.7", "0,6,0.", "0,6,0", "0,6", "0"}) {
    expect_complaint([&] { (void)remark_on(kRows + cut); }, "line 7: the file ends within the number");
  }
  std::string exponents;
  for (int k = 0; k < 4; ++k) exponents += "1.25e-0" + std::to_string(k) + "\n";
  expect_complaint([&] { (void)remark_on(exponents + "1.25e-0"); }, "expected 6, or an end of this line");
  // Three lines may be chance.
  EXPECT_NE(remark_on("0.125\n0.250\n0.375\n0.5"), "");
}

TEST(TextEnd, IsLookedAtInEveryFormat) {
  const TemporaryDirectory directory;
  const auto remarks = [&](const std::string& text) {
    write_file(directory.path() / "a.csv", text);
    return load_measured(directory.path() / "a.csv").remarks;
  };
  const std::string text = "theta_in_deg,theta_out_deg,delta_phi_deg,f\n0,0,0,0.1\n0,30,0,0.123";
  EXPECT_THAT(remarks(text), Contains(HasSubstr("its last line is not ended")));
  EXPECT_THAT(remarks(text + "\n"), Not(Contains(HasSubstr("not ended"))));
}

}  // namespace
}  // namespace lobe::test
