// SPDX-License-Identifier: BSD-3-Clause
// CycloneDDS 0.10 lets a program bring its own types: a table of functions for the type, one for
// its samples (dds/ddsi/ddsi_sertype.h, dds/ddsi/ddsi_serdata.h). Here a sample is a buffer.
#include "live/dds/raw_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_misc.h>
#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

namespace aims {
namespace {

constexpr std::size_t kHeader = 4;  ///< of a CDR message [bytes]

struct RawSample : ddsi_serdata {
  std::vector<std::byte> bytes;  ///< padded to a multiple of four, which is read behind the end
  std::size_t size = 0;          ///< without padding
  SampleOrigin origin;
};

const RawSample& raw(const ddsi_serdata* sample) { return *static_cast<const RawSample*>(sample); }

std::unique_ptr<RawSample> make_sample(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                       std::size_t size) {
  auto sample = std::make_unique<RawSample>();
  ddsi_serdata_init(sample.get(), type, kind);
  sample->hash = type->serdata_basehash;  // no key: all samples are of one instance
  sample->size = size;
  sample->bytes.resize((size + 3) & ~std::size_t{3});
  return sample;
}

// Samples.

/// As the headers of packet and submessage say, which DDS has checked and brought to the order of
/// bytes of this machine.
SampleOrigin origin_of(const nn_rdata& fragment) {
  SampleOrigin origin;
  Header_t packet;
  Data_DataFrag_common_t data;
  std::memcpy(&packet, NN_RMSG_PAYLOAD(fragment.rmsg), sizeof(packet));
  std::memcpy(&data, NN_RMSG_PAYLOADOFF(fragment.rmsg, NN_RDATA_SUBMSG_OFF(&fragment)),
              sizeof(data));
  std::memcpy(origin.writer.data(), &packet.guid_prefix, sizeof(packet.guid_prefix));
  std::memcpy(origin.writer.data() + sizeof(packet.guid_prefix), &data.writerId,
              sizeof(data.writerId));
  origin.number = fromSN(data.writerSN);
  return origin;
}

/// From the fragments of a network message, in order; they may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  if (size < kHeader || size > kMaxSample) return nullptr;
  auto sample = make_sample(type, kind, size);
  sample->origin = origin_of(*fragment);
  std::size_t filled = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (fragment->min > filled) return nullptr;
    if (end <= filled) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(sample->bytes.data() + filled, payload + (filled - fragment->min), end - filled);
    filled = end;
  }
  return filled == size ? sample.release() : nullptr;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  if (size < kHeader || size > kMaxSample) return nullptr;
  auto sample = make_sample(type, kind, size);
  std::size_t filled = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && filled < size; ++i) {
    const std::size_t part = std::min<std::size_t>(pieces[i].iov_len, size - filled);
    std::memcpy(sample->bytes.data() + filled, pieces[i].iov_base, part);
    filled += part;
  }
  return filled == size ? sample.release() : nullptr;
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash*) {
  return make_sample(type, SDK_KEY, 0).release();
}

ddsi_serdata* from_span(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* given) {
  if (kind != SDK_DATA) return make_sample(type, kind, 0).release();
  const auto& bytes = *static_cast<const std::span<const std::byte>*>(given);
  auto sample = make_sample(type, kind, bytes.size());
  std::ranges::copy(bytes, sample->bytes.begin());
  return sample.release();
}

ddsi_serdata* lend(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                   ddsrt_iovec_t* out) {
  out->iov_base = const_cast<std::byte*>(raw(sample).bytes.data() + offset);  // only read
  out->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(sample);
}

ddsi_serdata* key_of(const ddsi_serdata* sample) {
  auto key = make_sample(sample->type, SDK_KEY, 0);
  key->type = nullptr;  // a key belongs to no type
  return key.release();
}

std::size_t print_sample(const ddsi_sertype*, const ddsi_serdata* sample, char* text,
                         std::size_t size) {
  const std::string described = std::to_string(raw(sample).size) + " bytes";
  const std::size_t length = std::min(size - 1, described.size());
  described.copy(text, length);
  text[length] = '\0';
  return length;
}

constexpr ddsi_serdata_ops sample_functions() {
  ddsi_serdata_ops ops = {};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* sample) {
    return static_cast<std::uint32_t>(raw(sample).size);
  };
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = from_key;
  ops.from_sample = from_span;
  ops.to_ser = [](const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* out) {
    std::memcpy(out, raw(sample).bytes.data() + offset, size);
  };
  ops.to_ser_ref = lend;
  ops.to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); };
  // Samples are taken as they are, by `dds_takecdr`.
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.to_untyped = key_of;
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return true;
  };
  ops.free = [](ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); };
  ops.print = print_sample;
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* out, bool) { *out = {}; };
  return ops;
}

// The type.

constexpr ddsi_sertype_ops type_functions() {
  ddsi_sertype_ops ops = {};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void** pointers, const ddsi_sertype*, void*, std::size_t,
                           std::size_t count) { std::fill_n(pointers, count, nullptr); };
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };  // names are compared
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

constexpr ddsi_serdata_ops kSampleFunctions = sample_functions();
constexpr ddsi_sertype_ops kTypeFunctions = type_functions();

}  // namespace

ddsi_sertype* make_raw_type(const std::string& name) {
  auto* type = new ddsi_sertype();
  ddsi_sertype_init_flags(type, name.c_str(), &kTypeFunctions, &kSampleFunctions,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

std::span<const std::byte> raw_bytes(const ddsi_serdata& sample) {
  if (sample.kind != SDK_DATA) return {};
  return std::span(raw(&sample).bytes).first(raw(&sample).size);
}

SampleOrigin origin_of(const ddsi_serdata& sample) { return raw(&sample).origin; }

}  // namespace aims
