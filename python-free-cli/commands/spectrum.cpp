#include "lobe/algebra/spectrum.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

constexpr Count kOrdersOption{"orders"};
constexpr Number kThreshold{"threshold"};
constexpr Count kValuesOption{"values"};

constexpr std::size_t kOrders = 6;  // printed without --orders
constexpr std::size_t kValues = 3;  // printed without --values

std::string number(double value) {
  return std::isinf(value) ? "infinite" : fmt::format("{:.5g}", value);
}

std::string kind_text(const ChannelSpectrum& spectrum) {
  const std::string defect = fmt::format("{:.2g}", spectrum.reciprocity_defect);
  return spectrum.is_self_adjoint ? "eigenvalues (reciprocal; relative defect " + defect + ")"
                                  : "singular values (not reciprocal; relative defect " + defect + ")";
}

std::string sum_text(const SumRule& rule, std::string_view integral) {
  return fmt::format("{:.8g}; {} {}; deviation {:.1e}", rule.sum, integral, format_estimate(rule.integral),
                     rule.deviation);
}

std::vector<Field> fields_of(const BrdfTable& table, const Spectrum& spectrum, std::size_t channel) {
  const ChannelSpectrum& values = spectrum.channels[channel];
  const std::string smooth = table.has_delta() ? " of the smooth part" : "";
  std::vector<Field> fields;
  const auto add = [&](std::string_view name, std::string text) {
    fields.push_back({channel_name(name, table, channel), std::move(text)});
  };
  add("values", kind_text(values));
  add("norm |T|", format_estimate(values.norm));
  if (values.is_self_adjoint) {
    add("smallest eigenvalue", format_estimate(values.smallest));
    const Estimate& negative = values.negative_norm;
    add("negative part",
        (std::isinf(negative.value) ? "infinite" : format_estimate(negative)) + ", root of its squares' sum");
    add("sum" + smooth, sum_text(values.trace, "integral of f(L,L)"));
  }
  add("sum of squares" + smooth, sum_text(values.hilbert_schmidt, "integral of f^2"));
  add("effective rank",
      number(values.effective_rank) + " by entropy, " + number(values.participation_ratio) + " by participation ratio");
  add("numerical rank",
      fmt::format("{} values of at least {:.3g} |T|", number(values.numerical_rank), spectrum.threshold));
  add("of a white input", fmt::format("{:.4g} of the square is left, over the grid's {} components", values.white_share,
                                      table.grid.nodes()));
  return fields;
}

/// The largest values of the first orders.
std::string orders_text(const Session& session, const ChannelSpectrum& spectrum, bool is_isotropic) {
  const auto& arguments = session.arguments();
  const std::size_t orders = arguments.has(kOrdersOption) ? arguments.count(kOrdersOption) : kOrders;
  const std::size_t values = arguments.has(kValuesOption) ? arguments.count(kValuesOption) : kValues;
  std::vector<std::vector<std::string>> rows{{is_isotropic ? "order" : "", "times"}};
  for (std::size_t k = 1; k <= values; ++k) rows.front().push_back(fmt::format("value {}", k));
  for (const auto& order : spectrum.orders) {
    if (order.order >= orders) break;
    std::vector<std::string> row{is_isotropic ? std::to_string(order.order) : "all",
                                 std::to_string(order.multiplicity)};
    for (std::size_t k = 0; k < values; ++k) {
      row.push_back(k < order.values.size() ? format_estimate(order.values[k]) : "");
    }
    rows.push_back(std::move(row));
  }
  return format_table(rows, 1, session.colors_output());
}

std::string decay_text(const Session& session, const ChannelSpectrum& spectrum, bool is_isotropic) {
  std::vector<std::vector<std::string>> rows{{"noise / |T|", "components left", "last order", "information / bit"}};
  for (const auto& point : spectrum.decay) {
    rows.push_back({fmt::format("{:.0e}", point.level), number(point.components),
                    is_isotropic && std::isfinite(point.components) ? std::to_string(point.last_order) : "",
                    number(point.bits)});
  }
  return format_table(rows, 1, session.colors_output());
}

void print_text(Session& session, const BrdfTable& table, const Spectrum& spectrum) {
  const bool is_isotropic = table.form == TableForm::isotropic;
  std::vector<Field> fields = header_fields(table);
  for (std::size_t c = 0; c < table.channels; ++c) {
    const auto more = fields_of(table, spectrum, c);
    fields.insert(fields.end(), more.begin(), more.end());
  }
  session.print(fields_text(fields));
  for (std::size_t c = 0; c < table.channels; ++c) {
    session.print("\n");
    if (table.channels > 1)
      session.print(table.channel_names.empty() ? fmt::format("channel {}\n", c + 1) : table.channel_names[c] + "\n");
    session.print(orders_text(session, spectrum.channels[c], is_isotropic) + "\n" +
                  decay_text(session, spectrum.channels[c], is_isotropic));
  }
}

Json sum_json(const SumRule& rule) {
  return {{"sum", to_json(rule.sum)}, {"integral", to_json(rule.integral)}, {"deviation", to_json(rule.deviation)}};
}

Json order_json(const OrderSpectrum& order) {
  Json json{{"order", order.order},
            {"multiplicity", order.multiplicity},
            {"values", Json::array()},
            {"errors", Json::array()}};
  for (const auto& value : order.values) {
    json["values"].push_back(to_json(value.value));
    json["errors"].push_back(to_json(value.error));
  }
  return json;
}

Json channel_json(const ChannelSpectrum& spectrum) {
  Json json{{"is_self_adjoint", spectrum.is_self_adjoint},
            {"reciprocity_defect", spectrum.reciprocity_defect},
            {"norm", to_json(spectrum.norm)}};
  if (spectrum.is_self_adjoint) {
    json["smallest"] = to_json(spectrum.smallest);
    json["negative_norm"] = to_json(spectrum.negative_norm);
    json["trace"] = sum_json(spectrum.trace);
  }
  json["hilbert_schmidt"] = sum_json(spectrum.hilbert_schmidt);
  json["effective_rank"] = to_json(spectrum.effective_rank);
  json["participation_ratio"] = to_json(spectrum.participation_ratio);
  json["numerical_rank"] = to_json(spectrum.numerical_rank);
  json["white_share"] = to_json(spectrum.white_share);
  json["decay"] = Json::array();
  for (const auto& point : spectrum.decay) {
    json["decay"].push_back({{"level", point.level},
                             {"components", to_json(point.components)},
                             {"last_order", point.last_order},
                             {"bits", to_json(point.bits)}});
  }
  json["orders"] = Json::array();
  for (const auto& order : spectrum.orders) json["orders"].push_back(order_json(order));
  return json;
}

void print_json(Session& session, const Device& device, const BrdfTable& table, const Spectrum& spectrum) {
  Json answer = json_answer("spectrum");
  answer.update(header_json(table));
  answer["threshold"] = spectrum.threshold;
  answer["spectra"] = Json::array();
  for (const auto& channel : spectrum.channels) answer["spectra"].push_back(channel_json(channel));
  answer["units"] = {{"values", "1"}, {"trace", "1"}, {"hilbert_schmidt", "1"}, {"bits", "bit"}, {"bytes", "B"}};
  answer["memory"] = session.memory_json();
  answer["precision"] = to_string(session.precision());
  answer["device"] = to_json(device.info());
  session.print_json(answer);
}

ExitCode execute_spectrum(Session& session) {
  const auto& arguments = session.arguments();
  const std::array operand{session.operand(argument::a)};
  SpectrumOptions options;
  if (arguments.has(kThreshold)) options.threshold = arguments.number(kThreshold);
  const auto tabulation = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operand, TableUse::decomposition);

  options.progress = session.progress();
  const std::uint64_t block_bytes = spectrum_bytes(operand.front().shape_on(grid));
  session.state_memory(tabulated_bytes(operand, grid) + block_bytes, 0, block_bytes);
  const BrdfTable table = tabulated(session, device, operand.front(), grid, tabulation);
  const Spectrum values = spectrum(device, table, options);
  session.end_progress();
  if (session.wants_json()) {
    print_json(session, device, table, values);
  } else {
    print_text(session, table, values);
  }
  if (table.is_unresolved && !session.has_coarse_grid()) session.note_coarse(table.grid);
  return ExitCode::success;
}

}  // namespace

Command spectrum_command() {
  std::vector<Option> options{
      {.handle = kOrdersOption, .value = "N", .help = "azimuthal orders to print (default 6)"},
      {.handle = kValuesOption, .value = "N", .help = "values of each order to print (default 3)"},
      {.handle = kThreshold,
       .value = "X",
       .help = "count values of at least X |T| for the numerical rank (default 1e-3)"}};
  for (const auto& option :
       tabulation_options("the grid (default: the table's own; else as fine as a material or file needs)")) {
    options.push_back(option);
  }
  options.push_back(json_option());
  return {.name = "spectrum",
          .group = "Operators",
          .summary = "compute eigenvalues, and what composing loses",
          .description =
              "Computes the eigenvalues of a material or table as an operator, separately for each azimuthal order "
              "(functions of theta times cos or sin of order times phi; values of orders above 0 count twice), and "
              "their sums beside the integrals that they must equal. A table that is not reciprocal has singular "
              "values instead. Composing with A multiplies each component of a distribution by its value, and "
              "components weaker than noise are lost: the last list shows how many are left at each level of noise, "
              "and how many bits of information, half the sum of log2(1 + (value / noise)^2).\n"
              "The effective rank is exp(entropy) of the squares' shares, the participation ratio (sum of squares)^2 "
              "over sum of fourth powers; delta parts make both infinite. Errors are those of values and grid; if "
              "formulas are known, the grid's error is judged on a finer one. The JSON holds all orders and values.",
          .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
          .options = std::move(options),
          .examples = {{"a wide highlight", "lobe spectrum phong:n=5"},
                       {"a composition, which has singular values", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                       {"its largest values", "lobe spectrum c.h5 --orders 4 --values 5"}},
          .execute = execute_spectrum};
}

}  // namespace lobe::cli
