// The program of a test of which hermes_test() names the source, what moc makes of it, and the class.
#include TEST_SOURCE
#include TEST_MOC

#include <QTemporaryDir>

namespace {

/// What daemons keep, such as an emergency stop, is of this test alone.
const struct OwnState {
    OwnState() { qputenv("XDG_STATE_HOME", folder.path().toUtf8()); }
    QTemporaryDir folder;
} ownState;

} // namespace

QTEST_MAIN(TEST_CLASS)
