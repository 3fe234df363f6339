#include "protocol/ros/Cdr.h"
#include "protocol/ros/Definition.h"
#include "protocol/ros/Graph.h"
#include "protocol/ros/Marker.h"
#include "protocol/ros/Messages.h"
#include "protocol/ros/Ros1.h"
#include "tests/support/Rows.h"
#include "tests/support/Seed.h"

#include <QCryptographicHash>
#include <random>

using namespace hermes::ros;

Q_DECLARE_METATYPE(std::string)

namespace {

std::mt19937 randomBits(1);

unsigned draw(unsigned most) {
    return std::uniform_int_distribution<unsigned>(0, most)(randomBits);
}

/// Fills a message with what is drawn.
template <typename T>
void fill(T &value) {
    using Element = typename Elements<T>::Element;
    if constexpr (std::is_same_v<T, bool>) {
        value = draw(1) != 0;
    } else if constexpr (isPlain<T>) {
        value = T(draw(255));
    } else if constexpr (std::is_same_v<T, std::string>) {
        value.assign(draw(5), char('a' + draw(25)));
    } else if constexpr (!std::is_void_v<Element>) {
        if constexpr (std::is_same_v<T, std::vector<Element>>)
            value.resize(draw(3));
        for (Element &element : value)
            fill(element);
    } else {
        forEachField(value, [](const char *, auto &member) { fill(member); });
    }
}

template <typename M>
void hashed(const char *hash) {
    QTest::newRow(typeOf<M>()) << QByteArray(hash) << hashedTextOf<M>();
}

/// What one form writes is read again, is refused where it is cut, and nothing else happens where it is
/// damaged.
template <typename M, typename Write, typename Read>
void checkForm(const Write &write, const Read &read, std::size_t padding) {
    for (int round = 0; round < 20; ++round) {
        M message;
        fill(message);
        const std::string bytes = write(message);
        const auto again = read(bytes);
        QVERIFY2(again, again ? "" : again.error().c_str());
        QVERIFY(write(*again) == bytes);
        for (std::size_t cut = 0; cut < bytes.size(); cut += 1 + cut / 64)
            QVERIFY(!read(std::string_view(bytes).substr(0, cut)));
        QVERIFY(!read(bytes + std::string(padding + 1, 'x')));
        for (int i = 0; i < 20; ++i) {
            std::string damaged = bytes;
            damaged[draw(unsigned(bytes.size() - 1))] ^= char(1 << draw(7));
            if (const auto other = read(damaged); !other)
                QVERIFY(!other.error().empty());
        }
    }
}

template <typename M>
void checkMessage() {
    checkForm<M>([](const M &m) { return toCdr(m); }, [](std::string_view b) { return fromCdr<M>(b); }, 3);
    checkForm<M>([](const M &m) { return toRos1(m); }, [](std::string_view b) { return fromRos1<M>(b); }, 0);
}

template <typename... M>
void checkMessages() {
    (checkMessage<M>(), ...);
}

QByteArray hex(const std::string &bytes) {
    return QByteArray::fromStdString(bytes).toHex();
}

} // namespace

class TestRosMessages : public QObject {
    Q_OBJECT
private Q_SLOTS:
    /// Those of ROS 2 Jazzy. A hash is of every name, type and order.
    void theHashOfATypeIsThatOfRos_data() {
        QTest::addColumn<QByteArray>("hash");
        QTest::addColumn<std::string>("text");
        hashed<Header>("f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
        hashed<String>("df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
        hashed<PoseStamped>("10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8");
        hashed<PoseWithCovarianceStamped>("26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e");
        hashed<Twist>("9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a");
        hashed<TwistStamped>("5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64");
        hashed<TfMessage>("e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
        hashed<Path>("1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b");
        hashed<LaserScan>("64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828");
        hashed<PointCloud>("9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5");
        hashed<Odometry>("3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
        hashed<OccupancyGrid>("8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7");
        hashed<BatteryState>("4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741");
        hashed<NavSatFix>("62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404");
        hashed<JointState>("a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e");
        hashed<DiagnosticArray>("5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e");
        hashed<Log>("e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac");
        hashed<Clock>("692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564");
        hashed<MarkerArray>("86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf");
    }
    void theHashOfATypeIsThatOfRos() {
        FETCH(QByteArray, hash, std::string, text);
        QCOMPARE(
            QCryptographicHash::hash(QByteArray::fromStdString(text), QCryptographicHash::Sha256).toHex(),
            hash);
    }

    void bytesAreThoseOfCdr() {
        TransformStamped transform;
        transform.header = {{1, 2}, "map"};
        transform.childFrameId = "odom";
        transform.transform.translation.x = 1;
        QCOMPARE(hex(toCdr(transform)),
                 QByteArray("00010000" // little-endian
                            "01000000"
                            "02000000" // stamp
                            "04000000"
                            "6d617000" // "map", its end counted
                            "05000000"
                            "6f646f6d00" // "odom"
                            "000000"
                            "00000000" // to a multiple of 8
                            "000000000000f03f") +
                     QByteArray(5 * 16, '0') + "000000000000f03f");
        LaserScan scan;
        scan.ranges = {1};
        QCOMPARE(hex(toCdr(scan)).mid(2 * (4 + 8 + 8), 8 + 56 + 24).right(24), QByteArray("01000000"
                                                                                          "0000803f"
                                                                                          "00000000"));
    }

    void numbersOfEitherOrderAreRead() {
        const auto bool_ = fromCdr<Bool>(std::string_view("\0\1\0\0\7", 5));
        QVERIFY(bool_ && bool_->data);
        const auto clock = fromCdr<Clock>(std::string_view("\0\0\0\0\0\0\0\1\0\0\2\0", 12));
        QVERIFY(clock);
        QCOMPARE(clock->clock.sec, 1);
        QCOMPARE(clock->clock.nanosec, 512u);
        QCOMPARE(fromCdr<Clock>(std::string_view("\0\3\0\0\0\0\0\0\0\0\0\0", 12)).error(),
                 std::string("rosgraph_msgs/msg/Clock: expected the encapsulation CDR, found another"));
    }

    void headersOfRos1HaveANumber() {
        Header header{{1, 2}, "a"};
        QCOMPARE(hex(toRos1(header)), QByteArray("00000000"
                                                 "01000000"
                                                 "02000000"
                                                 "01000000"
                                                 "61"));
    }

    void drawnMessagesAreReadAgain() {
        randomBits.seed(newSeed());
        checkMessages<Header, String, PoseStamped, PoseWithCovarianceStamped, Twist, TwistStamped, TfMessage,
                      Path, LaserScan, PointCloud, Odometry, OccupancyGrid, BatteryState, NavSatFix,
                      JointState, DiagnosticArray, Log, Clock, MarkerArray, MultiEchoLaserScan, Bool,
                      PoseWithCovariance, ParticipantEntities<16>, ParticipantEntities<24>>();
    }

    /// A count that no bytes stand behind takes no memory.
    void whatIsTooLongIsRefusedWithItsPlace() {
        const std::string path = toRos1(Path()).substr(0, 16) + std::string(4, '\xff');
        QCOMPARE(fromRos1<Path>(path).error(),
                 std::string("nav_msgs/msg/Path: poses: at byte 20 of 20: expected 1 more"));
        LaserScan scan;
        std::string bytes = toCdr(scan);
        bytes.replace(bytes.size() - 8, 4, std::string(4, '\xff'));
        QVERIFY(fromCdr<LaserScan>(bytes).error().find("ranges: at byte") != std::string::npos);
    }

    void aDefinitionTellsAllItsTypes() {
        QCOMPARE(QByteArray::fromStdString(definitionOf<Clock>()),
                 "builtin_interfaces/Time clock\n" + QByteArray(80, '=') +
                     "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
        QVERIFY(definitionOf<Odometry>().find("float64[36] covariance\n") != std::string::npos);
        QVERIFY(definitionOf<DiagnosticArray>().find("byte level\n") != std::string::npos);
        QCOMPARE(ddsType(typeOf<LaserScan>()), std::string("sensor_msgs::msg::dds_::LaserScan_"));
    }
};
