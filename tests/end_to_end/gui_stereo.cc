// Presses the Stereo button of COLMAP's graphical interface, and looks at what
// it shows.
//
//   gui_stereo WORKSPACE         until the run is complete
//   gui_stereo WORKSPACE stop    presses the Stop button soon
//
// Exits with 0 if all was right.

#include <QApplication>
#include <QElapsedTimer>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTabWidget>
#include <QTableWidget>
#include <QTimer>
#include <cstdio>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "mvs/patch_match.h"
#include "ui/dense_reconstruction_widget.h"
#include "ui/main_window.h"
#include "util/option_manager.h"

namespace {

QPushButton* FindButton(QWidget* widget, const QString& text) {
  for (QPushButton* button : widget->findChildren<QPushButton*>()) {
    if (button->text() == text) {
      return button;
    }
  }
  return nullptr;
}

// All of our options, to the last digit.
std::string OptionsText(const tapa::HostOptions& options) {
  std::ostringstream text;
  text.precision(17);
  tapa::VisitHostOptions(
      &options, [&](const tapa::OptionEntry& entry, const auto* value) {
        text << entry.name << " = " << *value << std::endl;
      });
  return text.str();
}

using colmap::DenseReconstructionWidget;

// Our options have their rows.
bool CheckOptionRows(DenseReconstructionWidget* window,
                     colmap::OptionManager* options) {
  std::set<std::string> labels;
  for (const QLabel* label : window->findChildren<QLabel*>()) {
    labels.insert(label->text().toStdString());
  }
  std::vector<std::string> names = {"gpu_index"};
  tapa::VisitHostOptions(options->patch_match_stereo.get(),
                         [&](const tapa::OptionEntry& entry, auto*) {
                           names.push_back(entry.name);
                         });
  for (const std::string& name : names) {
    if (labels.count(name) == 0) {
      std::cerr << "There is no row for the option " << name << std::endl;
      return false;
    }
  }
  return true;
}

// Looking at our options changes none, however small it is.
bool CheckOptionsStay(DenseReconstructionWidget* window,
                      colmap::OptionManager* options) {
  options->patch_match_stereo->tapa.textureness_variance = 0.0000125;
  const std::string before = OptionsText(*options->patch_match_stereo);
  auto* tabs = window->findChild<QTabWidget*>();
  tabs->window()->show();
  for (int i = 0; i < tabs->count(); ++i) {
    tabs->setCurrentIndex(i);
    QApplication::processEvents();
  }
  tabs->window()->hide();
  QApplication::processEvents();
  const std::string after = OptionsText(*options->patch_match_stereo);
  if (before != after) {
    std::cerr << "The options widget has changed options:\n"
              << before << "now:\n"
              << after;
  }
  return before == after;
}

// Names the workspace, which enables the button later, by an event.
bool PressStereo(DenseReconstructionWidget* window, const char* workspace) {
  for (QLineEdit* edit : window->findChildren<QLineEdit*>()) {
    if (edit->parentWidget() == window) {
      edit->setText(workspace);
    }
  }
  QApplication::processEvents();
  QPushButton* button = FindButton(window, "Stereo");
  if (button == nullptr || !button->isEnabled()) {
    std::cerr << "The Stereo button is not enabled" << std::endl;
    return false;
  }
  button->click();
  return true;
}

// Looks, while a run goes on, at what the window shows of it.
class Watch {
 public:
  Watch(DenseReconstructionWidget* window, bool stops)
      : window_(window),
        stops_(stops),
        panel_(window->findChild<QWidget*>("tapa_stereo_panel")),
        text_(panel_->findChild<QLabel*>()),
        stop_button_(FindButton(panel_, "Stop")) {}

  // Returns false when the run has ended.
  bool Look() {
    if (stop_button_->isHidden()) {
      return false;
    }
    const std::string text = text_->text().toStdString();
    CountTexts(text);
    if (stops_ && stop_button_->isEnabled() &&
        text.find("to go") != std::string::npos) {
      stop_button_->click();
      since_stop_.start();
    }
    const size_t num_maps = MapButtons().size();
    was_partly_filled_ |= num_maps > 0 && num_maps < NumMaps();
    if (num_maps > 0 && !was_opened_) {
      OpenMap();
    }
    closes_ |= window_->close();
    others_enabled_ |= FindButton(window_, "Fusion")->isEnabled() ||
                       FindButton(window_, "Stereo")->isEnabled();
    return true;
  }

  // Prints what was not as it should be. Returns whether all was.
  bool Check() {
    Expect(!closes_, "the window stays open");
    Expect(!others_enabled_, "other buttons have to wait");
    Expect(FindButton(window_, "Stereo")->isEnabled(), "and are enabled again");
    if (stops_) {
      Expect(num_stops_ms_ < 1000, "it stops within a second");
      Expect(text_->text().startsWith("Stopped"), "it says that it stopped");
    } else {
      Expect(num_coarse_ > 0, "view, pass and level, and the time to go");
      Expect(num_full_ > 0, "the same of the full size");
      Expect(was_partly_filled_, "the table fills as maps come in");
      Expect(was_opened_, "a map can be opened while the run goes on");
      Expect(MapButtons().size() == NumMaps(), "all maps are in the table");
      Expect(text_->text().contains("complete"), "it says that it is complete");
    }
    return is_right_;
  }

 private:
  void CountTexts(const std::string& text) {
    static const std::regex coarse(
        "[0-9.]+ %  [0-9]+:[0-9]+:[0-9]+ to go  level 1 "
        "(photo|geo)metric [0-9]/4 view[0-9]\\.png");
    static const std::regex full(
        "[0-9.]+ %  [0-9]+:[0-9]+:[0-9]+ to go  "
        "(photo|geo)metric [0-9]/4 view[0-9]\\.png, full size");
    num_coarse_ += std::regex_match(text, coarse);
    num_full_ += std::regex_match(text, full);
    if (since_stop_.isValid()) {
      num_stops_ms_ = since_stop_.elapsed();
    }
  }

  QTableWidget* Table() { return window_->findChild<QTableWidget*>(); }
  // A photometric and a geometric one for each view.
  size_t NumMaps() { return 2 * Table()->rowCount(); }

  // Those that can be pressed.
  std::vector<QPushButton*> MapButtons() {
    std::vector<QPushButton*> buttons;
    for (int row = 0; row < Table()->rowCount(); ++row) {
      for (int col = 0; col < Table()->columnCount(); ++col) {
        // A cell that was replaced stays a child of the table for a while.
        QWidget* cell = Table()->cellWidget(row, col);
        QPushButton* button = cell ? FindButton(cell, "Depth map") : nullptr;
        if (button != nullptr && button->isEnabled()) {
          buttons.push_back(button);
        }
      }
    }
    return buttons;
  }

  void OpenMap() {
    QPushButton* button = MapButtons().front();
    Q_EMIT button->pressed();
    Q_EMIT button->released();
    for (QWidget* widget : window_->findChildren<QWidget*>()) {
      was_opened_ |= widget->windowTitle().startsWith("Depth map for") &&
                     widget->isVisible() && !widget->isModal();
    }
  }

  void Expect(bool condition, const char* what) {
    if (!condition) {
      // The window keeps what goes to std::cerr in its log.
      std::fprintf(stderr, "This is not so: %s\n", what);
      is_right_ = false;
    }
  }

  DenseReconstructionWidget* const window_;
  const bool stops_;
  QWidget* const panel_;
  QLabel* const text_;
  QPushButton* const stop_button_;
  QElapsedTimer since_stop_;
  qint64 num_stops_ms_ = 0;
  int num_coarse_ = 0;
  int num_full_ = 0;
  bool was_partly_filled_ = false;
  bool was_opened_ = false;
  bool closes_ = false;
  bool others_enabled_ = false;
  bool is_right_ = true;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: gui_stereo WORKSPACE [stop]" << std::endl;
    return 2;
  }
  const bool stops = argc == 3;
  colmap::InitializeGlog(argv);
  QApplication application(argc, argv);
  colmap::OptionManager options;
  options.AddAllOptions();
  options.patch_match_stereo->num_levels = 2;
  // With these a run takes seconds, or minutes if it is to be stopped.
  options.patch_match_stereo->num_iterations = stops ? 1000 : 10;
  options.patch_match_stereo->num_geom_iterations = 10;
  options.patch_match_stereo->window_radius = stops ? 15 : 3;
  colmap::MainWindow main_window(options);
  DenseReconstructionWidget window(&main_window, &options);
  window.show();
  if (!CheckOptionRows(&window, &options) ||
      !CheckOptionsStay(&window, &options) || !PressStereo(&window, argv[1])) {
    return 1;
  }
  Watch watch(&window, stops);
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&]() {
    if (!watch.Look()) {
      application.exit(watch.Check() ? 0 : 1);
    }
  });
  timer.start(10);
  return application.exec();
}
