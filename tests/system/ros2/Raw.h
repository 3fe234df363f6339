#pragma once
// Topics as bytes: the type of which only the name is known, and lines of JSON on standard output.
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/common/Guid.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace ros2 {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

/// Since the epoch.
inline std::int64_t now_ns() {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline std::string hexOf(const std::uint8_t *bytes, std::size_t size) {
    static const char digits[] = "0123456789abcdef";
    std::string text;
    text.reserve(2 * size);
    for (std::size_t i = 0; i < size; ++i)
        text += {digits[bytes[i] >> 4], digits[bytes[i] & 15]};
    return text;
}

inline std::string hexOf(const rtps::GUID_t &guid) {
    return hexOf(guid.guidPrefix.value, 12) + hexOf(guid.entityId.value, 4);
}

inline Bytes bytesOf(const std::string &hex) {
    if (hex.size() % 2 || hex.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::runtime_error("hex: expected pairs of hexadecimal digits");
    Bytes bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes.push_back(std::uint8_t(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

/// Writes a line, from any thread.
inline void tell(const Json &line) {
    static std::mutex mutex;
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace);
    const std::lock_guard lock(mutex);
    std::cout << text << std::endl;
}

/// A type of which only the name is known: its samples are bytes with their encapsulation.
class RawType : public dds::TopicDataType {
public:
    explicit RawType(const std::string &name) {
        setName(name.c_str());
        m_typeSize = 4096; // to begin with: payloads grow
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }
    bool serialize(void *data, rtps::SerializedPayload_t *payload) override {
        const Bytes &bytes = *static_cast<Bytes *>(data);
        if (bytes.size() > payload->max_size)
            return false;
        std::copy(bytes.begin(), bytes.end(), payload->data);
        payload->length = std::uint32_t(bytes.size());
        payload->encapsulation = CDR_LE;
        return true;
    }
    bool deserialize(rtps::SerializedPayload_t *payload, void *data) override {
        static_cast<Bytes *>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<std::uint32_t()> getSerializedSizeProvider(void *data) override {
        return [data] { return std::uint32_t(static_cast<Bytes *>(data)->size()); };
    }
    void *createData() override { return new Bytes; }
    void deleteData(void *data) override { delete static_cast<Bytes *>(data); }
    bool getKey(void *, rtps::InstanceHandle_t *, bool) override { return false; }
};

} // namespace ros2
