#include "device/map_segments.hpp"

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"

namespace lobe {

std::size_t SegmentTable::padded(std::size_t columns) {
  return (columns + kTile - 1) / kTile * kTile;
}

void SegmentTable::clear() {
  segments_.clear();
  size_ = 0;
}

std::size_t SegmentTable::add(std::size_t source, std::size_t step, std::size_t count, std::size_t target,
                              std::size_t columns) {
  const auto number = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  segments_.push_back({number(source), number(step), number(count), number(target), number(columns), number(size_),
                       number(padded(columns))});
  size_ += count * padded(columns);
  if (size_ > table_.size()) table_.resize(size_);
  return segments_.size() - 1;
}

void SegmentTable::add_as(std::size_t segment, std::size_t source, std::size_t step, std::size_t count,
                          std::size_t target, std::size_t columns) {
  const auto number = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  MapSegment added = segments_[segment];
  added.source = number(source);
  added.step = number(step);
  added.count = number(count);
  added.target = number(target);
  added.columns = number(columns);
  segments_.push_back(added);
}

SegmentMap::SegmentMap(const Device& device) : device_(device) {
  checked("cannot prepare maps of segments", [&] {
    const auto program =
        build_program(device_, {"prelude.clh", "products/map_segments.cl"}, Precision::double_precision);
    triples_ = make_kernel(program, "map_segments", 6);
    singles_ = make_kernel(program, "map_segments_of_pack", 7);
  });
  require_sound(device_, "map_segments.cl", [&] { return test_segment_map(device_); });
}

DeviceSegments SegmentMap::place(SegmentTable& table) const {
  return checked("cannot prepare maps of segments", [&] {
    return DeviceSegments{host_buffer(device_, table.segments(), CL_MEM_READ_ONLY),
                          host_buffer(device_, table.table(), CL_MEM_READ_ONLY), table.segments().size()};
  });
}

void SegmentMap::apply(const PackedRows& from, const PackedRows& to, std::size_t packs,
                       const DeviceSegments& segments) {
  checked("cannot map segments", [&] {
    auto& queue = device_.implementation().queue;
    const std::size_t triples = packs / 3;
    const auto launch = [&](cl::Kernel& kernel, std::size_t items) {
      if (items == 0) return;
      set_arguments(kernel, from.values, static_cast<cl_uint>(from.stride), to.values, static_cast<cl_uint>(to.stride),
                    segments.segments, segments.table);
      queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items, segments.count), cl::NDRange(1, 1));
    };
    launch(triples_, triples);
    singles_.setArg(6, static_cast<cl_uint>(3 * triples));
    launch(singles_, packs - 3 * triples);
  });
}

}  // namespace lobe
