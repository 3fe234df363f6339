// The program of a test of which hermes_test() names the source, what moc makes of it, and the class.
#include TEST_SOURCE
#include TEST_MOC
QTEST_MAIN(TEST_CLASS)
