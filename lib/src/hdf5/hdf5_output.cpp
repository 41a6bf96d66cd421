#include "hdf5/hdf5_output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "core/file_writer.hpp"
#include "hdf5/file_digest.hpp"
#include "lobe/core/error.hpp"

namespace lobe::hdf5 {

/// Where a file's bytes go: to the disk, or into memory.
class Sink {
 public:
  Sink() = default;
  explicit Sink(const std::filesystem::path& path)
      : descriptor_(retried([&] { return ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666); })) {
    if (descriptor_ < 0) failure_ = errno;
  }
  ~Sink() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// errno of the first failure, else 0.
  [[nodiscard]] int failure() const { return failure_; }

  void write(off_t offset, const char* bytes, std::size_t size) {
    if (is_in_memory()) {
      const std::size_t begin = static_cast<std::size_t>(offset);
      if (image_.size() < begin + size) image_.resize(begin + size);
      std::memcpy(image_.data() + begin, bytes, size);
      return;
    }
    while (failure_ == 0 && size > 0) {
      const ssize_t count = retried([&] { return ::pwrite(descriptor_, bytes, size, offset); });
      if (count < 0) {
        failure_ = errno;
        return;
      }
      bytes += count;
      offset += count;
      size -= static_cast<std::size_t>(count);
    }
  }

  /// Bytes that were never written are 0.
  void read(off_t offset, char* bytes, std::size_t size) {
    if (is_in_memory()) {
      const std::size_t begin = std::min(static_cast<std::size_t>(offset), image_.size());
      const std::size_t there = std::min(size, image_.size() - begin);
      std::memcpy(bytes, image_.data() + begin, there);
      std::memset(bytes + there, 0, size - there);
      return;
    }
    while (size > 0) {
      const ssize_t count = retried([&] { return ::pread(descriptor_, bytes, size, offset); });
      if (count < 0 && failure_ == 0) failure_ = errno;
      if (count <= 0) break;
      bytes += count;
      offset += count;
      size -= static_cast<std::size_t>(count);
    }
    std::memset(bytes, 0, size);
  }

  /// Marks everything written from now on as chunks, or not.
  void begin_chunk(bool is_chunk) { is_chunk_ = is_chunk; }
  /// Notes bytes that have a checksum of their own.
  void note_chunk(std::uint64_t offset, std::uint64_t size) {
    if (!is_chunk_) return;
    if (!chunks_.empty() && chunks_.back().offset + chunks_.back().size == offset) {
      chunks_.back().size += size;
    } else {
      chunks_.push_back({offset, size});
    }
  }
  /// Puts a checksum behind a complete file.
  void append_digest() {
    struct stat status {};
    if (failure_ == 0 && ::fstat(descriptor_, &status) != 0) failure_ = errno;
    if (failure_ != 0) return;
    const std::string digest = digest_of(static_cast<std::uint64_t>(status.st_size), chunks_,
                                         [this](std::uint64_t offset, char* bytes, std::size_t count) {
                                           read(static_cast<off_t>(offset), bytes, count);
                                         });
    write(status.st_size, digest.data(), digest.size());
  }

  void resize(off_t size) {
    if (is_in_memory()) {
      image_.resize(static_cast<std::size_t>(size));
      return;
    }
    if (failure_ == 0 && retried([&] { return ::ftruncate(descriptor_, size); }) != 0) failure_ = errno;
  }

  /// The bytes in memory.
  [[nodiscard]] std::string take_image() { return std::move(image_); }

 private:
  [[nodiscard]] bool is_in_memory() const { return descriptor_ == kNoFile; }

  static constexpr int kNoFile = -2;
  int descriptor_ = kNoFile;
  int failure_ = 0;
  std::string image_;
  bool is_chunk_ = false;
  std::vector<ByteRange> chunks_;
};

namespace {

/// The driver's settings.
struct SinkSettings {
  Sink* sink = nullptr;
};

/// An open file as HDF5's drivers see it: its own part comes first.
struct SinkFile {
  H5FD_t base{};
  Sink* sink = nullptr;
  haddr_t end_of_space = 0;  ///< end of the space that HDF5 has allocated
  haddr_t end_of_file = 0;   ///< end of the written bytes
};

SinkFile& sink_file(H5FD_t* file) {
  return *reinterpret_cast<SinkFile*>(file);
}

const SinkFile& sink_file(const H5FD_t* file) {
  return *reinterpret_cast<const SinkFile*>(file);
}

H5FD_t* open_sink(const char*, unsigned, hid_t access, haddr_t) {
  const auto* settings = static_cast<const SinkSettings*>(H5Pget_driver_info(access));
  if (settings == nullptr) return nullptr;
  return &(new SinkFile{{}, settings->sink})->base;
}

herr_t close_sink(H5FD_t* file) {
  delete &sink_file(file);
  return 0;
}

herr_t query_sink(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t end_of_space(const H5FD_t* file, H5FD_mem_t) {
  return sink_file(file).end_of_space;
}

herr_t set_end_of_space(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  sink_file(file).end_of_space = address;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) {
  return sink_file(file).end_of_file;
}

herr_t read_sink(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* bytes) {
  sink_file(file).sink->read(static_cast<off_t>(address), static_cast<char*>(bytes), size);
  return 0;
}

herr_t write_sink(H5FD_t* file, H5FD_mem_t kind, hid_t, haddr_t address, std::size_t size, const void* bytes) {
  SinkFile& target = sink_file(file);
  if (kind == H5FD_MEM_DRAW) target.sink->note_chunk(address, size);
  target.sink->write(static_cast<off_t>(address), static_cast<const char*>(bytes), size);
  target.end_of_file = std::max(target.end_of_file, address + size);
  return 0;
}

herr_t truncate_sink(H5FD_t* file, hid_t, hbool_t) {
  SinkFile& target = sink_file(file);
  if (target.end_of_file != target.end_of_space) target.sink->resize(static_cast<off_t>(target.end_of_space));
  target.end_of_file = target.end_of_space;
  return 0;
}

H5FD_class_t sink_class() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION  // HDF5 1.14
  driver.version = H5FD_CLASS_VERSION;
  driver.value = H5_VFD_RESERVED;  // nothing looks it up by that
#endif
  driver.name = "lobe_sink";
  driver.maxaddr = haddr_t{1} << 62U;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(SinkSettings);
  driver.open = open_sink;
  driver.close = close_sink;
  driver.query = query_sink;
  driver.get_eoa = end_of_space;
  driver.set_eoa = set_end_of_space;
  driver.get_eof = end_of_file;
  driver.read = read_sink;
  driver.write = write_sink;
  driver.truncate = truncate_sink;
  constexpr H5FD_mem_t kKinds[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(kKinds, driver.fl_map);
  return driver;
}

using Driver = Handle<H5FDunregister>;

/// A file by the conventions of every file lobe writes: link and attribute order kept, no time stamps. It keeps the
/// driver for itself as long as it is open.
File create_file(Sink* sink) {
  static const H5FD_class_t kClass = sink_class();
  constexpr const char* kOperation = "create an HDF5 file";
  constexpr unsigned kOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;  // netCDF-4 asks for both
  const Driver driver(H5FDregister(&kClass), "register a file driver");
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), kOperation);
  const SinkSettings settings{sink};
  check(H5Pset_driver(access.id(), driver.id(), &settings), kOperation);
  check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V110), kOperation);
  check(H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG), kOperation);
  const Properties creation(H5Pcreate(H5P_FILE_CREATE), kOperation);
  check(H5Pset_link_creation_order(creation.id(), kOrder), kOperation);
  check(H5Pset_attr_creation_order(creation.id(), kOrder), kOperation);
  check(H5Pset_obj_track_times(creation.id(), false), kOperation);
  return {H5Fcreate("lobe", H5F_ACC_TRUNC, creation.id(), access.id()), kOperation};
}

}  // namespace

std::string file_image(const std::function<void(hid_t root)>& fill) {
  const QuietErrors quiet;
  Sink sink;
  {
    const File file = create_file(&sink);
    {
      const Group root(H5Gopen2(file.id(), "/", H5P_DEFAULT), "open the root group");
      fill(root.id());
    }
    check(H5Fflush(file.id(), H5F_SCOPE_GLOBAL), "complete the file");
  }
  return sink.take_image();
}

OutputFile::OutputFile(const std::filesystem::path& path, std::string name)
    : name_(std::move(name)), sink_(std::make_unique<Sink>(path)) {
  check_writes();
  file_.emplace(create_file(sink_.get()));
  root_.emplace(H5Gopen2(file_->id(), "/", H5P_DEFAULT), "open the root group");
}

OutputFile::~OutputFile() = default;

void OutputFile::check_writes() const {
  if (sink_->failure() == 0) return;
  const std::error_code code(sink_->failure(), std::generic_category());
  throw IoError("cannot write " + name_ + ": " + code.message(), {.fault = fault_of(code), .path = name_});
}

void OutputFile::close() {
  check(H5Fflush(file_->id(), H5F_SCOPE_GLOBAL), "complete " + name_);
  root_.reset();
  file_.reset();
  sink_->append_digest();
  check_writes();
}

void OutputFile::write_chunk(const Dataset& dataset, std::span<const hsize_t> offset,
                             std::span<const unsigned char> bytes) {
  sink_->begin_chunk(true);
  const herr_t written = H5Dwrite_chunk(dataset.id(), H5P_DEFAULT, 0, offset.data(), bytes.size(), bytes.data());
  sink_->begin_chunk(false);
  check(written, "write a chunk");
}

}  // namespace lobe::hdf5
