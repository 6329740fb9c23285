// Presses the Stereo button of COLMAP's graphical interface.
//
//   gui_stereo WORKSPACE
//
// Exits with 0 when the button's run has ended.

#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QProgressDialog>
#include <QPushButton>
#include <QTabWidget>
#include <QTimer>
#include <iostream>
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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: gui_stereo WORKSPACE" << std::endl;
    return 2;
  }
  colmap::InitializeGlog(argv);
  QApplication application(argc, argv);
  colmap::OptionManager options;
  options.AddAllOptions();
  options.patch_match_stereo->num_iterations = 1;
  options.patch_match_stereo->window_radius = 3;
  colmap::MainWindow main_window(options);
  colmap::DenseReconstructionWidget dense_widget(&main_window, &options);
  dense_widget.show();

  // Our options have their rows.
  std::set<std::string> labels;
  for (const QLabel* label : dense_widget.findChildren<QLabel*>()) {
    labels.insert(label->text().toStdString());
  }
  std::vector<std::string> names = {"gpu_index"};
  tapa::VisitHostOptions(options.patch_match_stereo.get(),
                         [&](const tapa::OptionEntry& entry, auto*) {
                           names.push_back(entry.name);
                         });
  for (const std::string& name : names) {
    if (labels.count(name) == 0) {
      std::cerr << "There is no row for the option " << name << std::endl;
      return 1;
    }
  }

  // Looking at our options changes none, however small it is.
  options.patch_match_stereo->tapa.textureness_variance = 0.0000125;
  const std::string before = OptionsText(*options.patch_match_stereo);
  auto* tabs = dense_widget.findChild<QTabWidget*>();
  tabs->window()->show();
  for (int i = 0; i < tabs->count(); ++i) {
    tabs->setCurrentIndex(i);
    application.processEvents();
  }
  tabs->window()->hide();
  application.processEvents();
  const std::string after = OptionsText(*options.patch_match_stereo);
  if (before != after) {
    std::cerr << "The options widget has changed options:\n"
              << before << "now:\n"
              << after;
    return 1;
  }

  // Naming the workspace enables the button, later, by an event.
  QPushButton* stereo_button = FindButton(&dense_widget, "Stereo");
  for (QLineEdit* edit : dense_widget.findChildren<QLineEdit*>()) {
    if (edit->parentWidget() == &dense_widget) {
      edit->setText(argv[1]);
    }
  }
  application.processEvents();
  if (stereo_button == nullptr || !stereo_button->isEnabled()) {
    std::cerr << "The Stereo button is not enabled" << std::endl;
    return 1;
  }
  stereo_button->click();

  // The dialog with the progress hides when the run has ended.
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&]() {
    const auto dialogs = dense_widget.findChildren<QProgressDialog*>();
    if (!dialogs.empty() && !dialogs.first()->isVisible()) {
      application.quit();
    }
  });
  timer.start(50);
  return application.exec();
}
