#include "daemons/scanmatcher/ScanMatcher.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::scanmatcher::ScanMatcher>(argc, argv);
}
