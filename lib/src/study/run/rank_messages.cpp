#include "study/run/rank_messages.hpp"

#include <new>

#include "lobe/core/error.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/record_stream.hpp"

namespace lobe {
namespace {

/// Types of errors, the most special ones first.
enum class ErrorKind : std::uint64_t { unresolved, argument, io, device, numeric, cancelled, memory, other };

std::string text_of_error(ErrorKind kind, const std::string& what, const ErrorFields& fields,
                          const std::string& build_log) {
  RecordWriter writer;
  writer.take(static_cast<std::uint64_t>(kind));
  writer.take(std::string_view(what));
  writer.take(static_cast<std::uint64_t>(fields.fault));
  writer.take(static_cast<std::uint64_t>(fields.topic));
  for (const auto* text : {&fields.path, &fields.grid, &build_log}) writer.take(std::string_view(*text));
  return writer.text();
}

std::string taken_text(RecordReader& reader) {
  std::string_view text;
  reader.take(text);
  return std::string(text);
}

}  // namespace

std::string written_rank_text(const RankText& text) {
  RecordWriter writer;
  writer.take(static_cast<std::uint64_t>(text.word));
  writer.take(std::string_view(text.name));
  writer.take(std::string_view(text.content));
  writer.take(record_checksum(text.name, text.content));
  return writer.text();
}

std::optional<RankText> read_rank_text(std::string_view bytes) {
  RecordReader reader(bytes);
  std::uint64_t word = 0;
  std::uint64_t sum = 0;
  RankText text;
  reader.take(word);
  text.name = taken_text(reader);
  text.content = taken_text(reader);
  reader.take(sum);
  if (!reader.is_good() || reader.left() > 0 || word > static_cast<std::uint64_t>(RankWord::left)) return {};
  if (sum != record_checksum(text.name, text.content)) return {};
  text.word = static_cast<RankWord>(word);
  return text;
}

std::string written_error(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const UnresolvedError& found) {
    return text_of_error(ErrorKind::unresolved, found.what(), found.fields(), {});
  } catch (const ArgumentError& found) {
    return text_of_error(ErrorKind::argument, found.what(), found.fields(), {});
  } catch (const IoError& found) {
    return text_of_error(ErrorKind::io, found.what(), found.fields(), {});
  } catch (const DeviceError& found) {
    return text_of_error(ErrorKind::device, found.what(), found.fields(), found.build_log());
  } catch (const NumericError& found) {
    return text_of_error(ErrorKind::numeric, found.what(), found.fields(), {});
  } catch (const Cancelled& found) {
    return text_of_error(ErrorKind::cancelled, found.what(), found.fields(), {});
  } catch (const std::bad_alloc&) {
    return text_of_error(ErrorKind::memory, "out of memory", {}, {});
  } catch (const std::exception& found) {
    return text_of_error(ErrorKind::other, found.what(), {}, {});
  }
}

void throw_written_error(std::string_view content, const std::string& rank) {
  RecordReader reader(content);
  std::uint64_t kind = 0;
  std::uint64_t fault = 0;
  std::uint64_t topic = 0;
  reader.take(kind);
  const std::string what = taken_text(reader);
  reader.take(fault);
  reader.take(topic);
  ErrorFields fields{.fault = static_cast<Fault>(fault), .topic = static_cast<Topic>(topic)};
  fields.path = taken_text(reader);
  fields.grid = taken_text(reader);
  const std::string build_log = taken_text(reader);
  switch (static_cast<ErrorKind>(kind)) {
    // What is wrong with a study is the same everywhere.
    case ErrorKind::unresolved:
      throw UnresolvedError(what, fields);
    case ErrorKind::argument:
      throw ArgumentError(what, fields);
    case ErrorKind::numeric:
      throw NumericError(what, fields);
    // Files, devices and memory are those of a machine.
    case ErrorKind::io:
      throw IoError(rank + ": " + what, fields);
    case ErrorKind::device:
      throw DeviceError(rank + ": " + what, build_log, fields);
    case ErrorKind::cancelled:
      throw DeviceError(rank + " was told to stop; give the same command again, to go on from what is kept");
    case ErrorKind::memory:
      throw NumericError(rank + ": out of memory; use fewer ranks on a machine, fewer materials or a larger tolerance");
    case ErrorKind::other:
      break;
  }
  throw NumericError(rank + ": " + what);
}

}  // namespace lobe
