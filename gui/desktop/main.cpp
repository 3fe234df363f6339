#include "common/Project.h"
#include "common/help/HelpText.h"
#include "gui/desktop/EndSignals.h"
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/MessageWriter.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/MapPanel.h"

#include <QApplication>
#include <QCommandLineParser>
#include <QStandardPaths>
#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

using namespace hermes;
using namespace hermes::desktop;

namespace {

/// Of a command line whose answer is text on the terminal.
bool onlyPrints(int argc, char **argv) {
    const std::vector<std::string_view> words(argv + 1, argv + argc);
    return std::any_of(words.begin(), words.end(), [](std::string_view word) {
        return word == "--help" || word == "-h" || word == "--version" || word == "-v";
    });
}

/// Qt would abort.
bool lacksDisplay(int argc, char **argv) {
    const std::vector<std::string_view> words(argv + 1, argv + argc);
    const char *const says[] = {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"};
    return QSysInfo::kernelType() == "linux" &&
           std::all_of(std::begin(says), std::end(says), qEnvironmentVariableIsEmpty) &&
           std::find(words.begin(), words.end(), "-platform") == words.end();
}

} // namespace

int main(int argc, char **argv) {
    if (onlyPrints(argc, argv))
        qputenv("QT_QPA_PLATFORM", "offscreen"); // needs no display
    if (lacksDisplay(argc, argv)) {
        std::fputs(
            "hermes-gui: this computer has no display (DISPLAY, WAYLAND_DISPLAY). Start the window on "
            "your own computer, and connect it to the robot: docs/remote.md. In a terminal use hermesctl.\n",
            stderr);
        return 1;
    }
    QCoreApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
    QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
    QApplication application(argc, argv);
    QApplication::setApplicationName("hermes-gui");
    QApplication::setApplicationVersion(projectVersion());
    QApplication::setDesktopFileName("hermes-gui");
    QApplication::setWindowIcon(QIcon::fromTheme("hermes", QIcon(":/icons/robot.svg")));
    theme::apply();

    QCommandLineParser parser;
    parser.setApplicationDescription("The operator's window: sees, drives and manages robots.");
    parser.addHelpOption();
    parser.addVersionOption();
    parser.addOption(
        {"connect",
         "A robot to connect to, or one of its daemons; repeatable (those of last time, else 127.0.0.1).",
         "HOST[:PORT]"});
    parser.addOption({"layout", "Where the layout of the window is kept.", "FILE",
                      QStandardPaths::writableLocation(QStandardPaths::ConfigLocation) + "/hermes/gui.json"});
    parser.addOption(
        {"whole-map", "Begin with the whole map in view, as it grows, and do not follow the robot."});
    if (!parser.parse(QApplication::arguments()) || !parser.positionalArguments().isEmpty()) {
        const QString wrong = parser.errorText().isEmpty()
                                  ? "unexpected argument '" + parser.positionalArguments().value(0) + "'"
                                  : parser.errorText();
        std::fprintf(stderr, "hermes-gui: %s\nhermes-gui --help tells what there is\n", qPrintable(wrong));
        return 2;
    }
    if (parser.isSet("help")) {
        std::fputs(fittedHelp(parser.helpText().toStdString()).c_str(), stdout);
        return 0;
    }
    if (parser.isSet("version"))
        parser.showVersion();

    Fleet fleet;
    for (const QString &address : parser.values("connect"))
        if (const auto added = fleet.add(address); !added) {
            std::fprintf(stderr, "hermes-gui: --connect: %s\n", qPrintable(added.error().message));
            return 2;
        }
    if (fleet.robots().empty())
        for (const QString &address : MainWindow::keptAddresses(parser.value("layout")))
            fleet.add(address); // what is no address is passed over
    if (fleet.robots().empty())
        fleet.add("127.0.0.1");
    const MessageWriter writer;
    DriveControl drive(fleet);
    MainWindow window(fleet, drive, parser.value("layout"));
    if (parser.isSet("whole-map"))
        window.map().view().fit();
    const EndSignals signals;
    QObject::connect(&signals, &EndSignals::endWanted, &window, &MainWindow::leave);
    window.show();
    return QApplication::exec();
}
