#include "daemons/ros2/RawType.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#pragma GCC diagnostic pop

#include <cstring>

namespace hermes::ros2 {
namespace {

constexpr std::size_t wordBytes = 4; // the wire has whole words

struct RawSample : ddsi_serdata {
    std::string bytes;
};

const RawSample &rawSample(const ddsi_serdata *sample) {
    return *static_cast<const RawSample *>(sample);
}

RawSample *makeSample(const ddsi_sertype *type, ddsi_serdata_kind kind) {
    auto *const sample = new RawSample;
    ddsi_serdata_init(sample, type, kind);
    return sample;
}

/// To whole words; how many bytes were added stands in the encapsulation.
void pad(std::string &bytes) {
    const std::size_t added = (wordBytes - bytes.size() % wordBytes) % wordBytes;
    bytes.append(added, '\0');
    if (bytes.size() >= wordBytes)
        bytes[3] = char(added);
}

bool haveSameKey(const ddsi_serdata *, const ddsi_serdata *) {
    return true; // there is none
}

std::uint32_t sizeOf(const ddsi_serdata *sample) {
    return std::uint32_t(rawSample(sample).bytes.size());
}

/// From the datagrams that it came in; they may overlap.
ddsi_serdata *fromFragments(const ddsi_sertype *type, ddsi_serdata_kind kind, const nn_rdata *fragment,
                            std::size_t size) {
    RawSample *const sample = makeSample(type, kind);
    sample->bytes.reserve(size);
    for (; fragment && sample->bytes.size() < size; fragment = fragment->nextfrag) {
        const std::size_t have = sample->bytes.size();
        if (fragment->maxp1 <= have)
            continue;
        const unsigned char *const payload =
            NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
        sample->bytes.append(reinterpret_cast<const char *>(payload) + (have - fragment->min),
                             fragment->maxp1 - have);
    }
    sample->bytes.resize(size);
    return sample;
}

ddsi_serdata *fromVectors(const ddsi_sertype *type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t *vectors, std::size_t size) {
    RawSample *const sample = makeSample(type, kind);
    for (ddsrt_msg_iovlen_t i = 0; i < count; ++i)
        sample->bytes.append(static_cast<const char *>(vectors[i].iov_base), vectors[i].iov_len);
    sample->bytes.resize(size);
    return sample;
}

ddsi_serdata *fromKeyHash(const ddsi_sertype *type, const ddsi_keyhash *) {
    return makeSample(type, SDK_KEY);
}

ddsi_serdata *fromNothing(const ddsi_sertype *, ddsi_serdata_kind, const void *) {
    return nullptr; // samples are made of bytes alone
}

void copyBytes(const ddsi_serdata *sample, std::size_t from, std::size_t size, void *to) {
    std::memcpy(to, rawSample(sample).bytes.data() + from, size);
}

ddsi_serdata *lendBytes(const ddsi_serdata *sample, std::size_t from, std::size_t size, ddsrt_iovec_t *to) {
    to->iov_base = const_cast<char *>(rawSample(sample).bytes.data()) + from;
    to->iov_len = size;
    return ddsi_serdata_ref(sample);
}

void takeBytesBack(ddsi_serdata *sample, const ddsrt_iovec_t *) {
    ddsi_serdata_unref(sample);
}

bool toNothing(const ddsi_serdata *, void *, void **, void *) {
    return false;
}

ddsi_serdata *withoutType(const ddsi_serdata *sample) {
    RawSample *const key = makeSample(sample->type, SDK_KEY);
    key->type = nullptr;
    return key;
}

bool toInvalid(const ddsi_sertype *, const ddsi_serdata *, void *, void **, void *) {
    return true;
}

void freeSample(ddsi_serdata *sample) {
    delete static_cast<RawSample *>(sample);
}

std::size_t printNothing(const ddsi_sertype *, const ddsi_serdata *, char *text, std::size_t) {
    text[0] = '\0';
    return 0;
}

void noKeyHash(const ddsi_serdata *, ddsi_keyhash *hash, bool) {
    std::memset(hash, 0, sizeof *hash);
}

ddsi_serdata_ops sampleOperations() {
    ddsi_serdata_ops all{};
    all.eqkey = haveSameKey;
    all.get_size = sizeOf;
    all.from_ser = fromFragments;
    all.from_ser_iov = fromVectors;
    all.from_keyhash = fromKeyHash;
    all.from_sample = fromNothing;
    all.to_ser = copyBytes;
    all.to_ser_ref = lendBytes;
    all.to_ser_unref = takeBytesBack;
    all.to_sample = toNothing;
    all.to_untyped = withoutType;
    all.untyped_to_sample = toInvalid;
    all.free = freeSample;
    all.print = printNothing;
    all.get_keyhash = noKeyHash;
    return all;
}

void freeType(ddsi_sertype *type) {
    ddsi_sertype_fini(type);
    delete type;
}

bool areEqual(const ddsi_sertype *, const ddsi_sertype *) {
    return true; // their names are
}

std::uint32_t noHash(const ddsi_sertype *) {
    return 0;
}

void noSamples(const ddsi_sertype *, void *, std::size_t) {}

/// Of readers that are taken from by dds_takecdr alone: never called with a count above 0 that is used.
void noRoom(void **samples, const ddsi_sertype *, void *, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        samples[i] = nullptr;
}

void freeNone(const ddsi_sertype *, void **, std::size_t, dds_free_op_t) {}

ddsi_sertype_ops typeOperations() {
    ddsi_sertype_ops all{};
    all.version = ddsi_sertype_v0;
    all.free = freeType;
    all.zero_samples = noSamples;
    all.realloc_samples = noRoom;
    all.free_samples = freeNone;
    all.equal = areEqual;
    all.hash = noHash;
    return all;
}

} // namespace

ddsi_sertype *newRawType(const std::string &name) {
    static const ddsi_sertype_ops ofType = typeOperations();
    static const ddsi_serdata_ops ofSamples = sampleOperations();
    auto *const type = new ddsi_sertype{};
    ddsi_sertype_init_flags(type, name.c_str(), &ofType, &ofSamples, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
    type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
    return type;
}

ddsi_serdata *newRawSample(const ddsi_sertype *type, std::string_view cdr) {
    RawSample *const sample = makeSample(type, SDK_DATA);
    sample->bytes.reserve(cdr.size() + wordBytes);
    sample->bytes = cdr;
    pad(sample->bytes);
    return sample;
}

std::string_view bytesOf(const ddsi_serdata *sample) {
    return rawSample(sample).bytes;
}

void releaseRawSample(ddsi_serdata *sample) {
    ddsi_serdata_unref(sample);
}

} // namespace hermes::ros2
