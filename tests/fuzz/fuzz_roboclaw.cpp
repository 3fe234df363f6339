#include "tests/fuzz/FuzzInput.h"

#include "protocol/drive/Bus.h"
#include "protocol/roboclaw/Packet.h"

using namespace hermes::roboclaw;
using hermes::drive::Bus;

namespace {

Values takeValues(FuzzInput &in, std::string_view fields) {
    Values values;
    for (const char field : fields)
        values.push(field == 'B'   ? in.take<std::uint8_t>()
                    : field == 'H' ? in.take<std::uint16_t>()
                    : field == 'h' ? in.take<std::int16_t>()
                    : field == 'i' ? std::int64_t(in.take<std::int32_t>())
                                   : std::int64_t(in.take<std::uint32_t>()));
    return values;
}

/// What a device takes for a request is one that a host could have sent.
void requireSound(const Request &request) {
    const auto again = Request::make(request.address, request.command, request.values);
    FUZZ_REQUIRE(again && again->bytes.size() == request.bytes.size());
    for (std::size_t i = 0; i < again->bytes.size(); ++i)
        FUZZ_REQUIRE(again->bytes[i] == request.bytes[i]);
}

} // namespace

/// Any bytes at any time: a device accepts whole requests only, a bus ends each request once.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    RequestParser device(in.flag() ? Dialect::Usual : Dialect::Other);
    Bus bus;
    ReplyParser parser;
    double now = 0;
    std::uint64_t submitted = 0, ended = 0;
    for (int i = 0; in.left() > 0 && i < 500; ++i) {
        const auto kind = in.take<std::uint8_t>();
        now += (kind >> 3) * 0.002;
        if (kind % 8 == 0) {
            const std::uint8_t command = in.take<std::uint8_t>();
            const Layout *layout = layoutOf(command);
            if (!layout)
                continue;
            const auto request =
                Request::make(std::uint8_t(0x80 + in.take<std::uint8_t>() % 8), Command(command),
                              takeValues(in, layout->isRead ? layout->arguments : layout->fields));
            FUZZ_REQUIRE(request);
            submitted += bus.submit(
                {&parser, request->bytes, request->address}, [&ended](const Bus::Outcome &) { ++ended; },
                Bus::Urgency(in.flag()));
        } else if (kind % 8 == 1) {
            bus.cancel();
        } else if (kind % 8 == 2) {
            bus.setOpen(in.flag());
        } else if (kind % 8 == 3) {
            device.silence();
        } else {
            for (const char byte : in.bytes(in.take<std::uint8_t>() % 64)) {
                const auto value = std::uint8_t(byte);
                bus.feed(&value, 1, now);
                if (device.feed(value) == RequestParser::Result::Done)
                    requireSound(device.request());
                FUZZ_REQUIRE(device.pending() < 40);
            }
        }
        bus.poll(now);
        FUZZ_REQUIRE(ended <= submitted);
    }
    bus.setOpen(false);
    FUZZ_REQUIRE(ended == submitted && bus.isIdle());
    return 0;
}
