#include "daemons/recorder/Recorder.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::recorder::Recorder>(argc, argv);
}
