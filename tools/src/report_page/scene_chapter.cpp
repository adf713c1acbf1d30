#include "explain/explain_sections.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
#include "report_page/chapters.h"

namespace palpate::tools {

void addSceneChapter(HtmlPage& page, const LoadedScene& loaded, const SceneChapter& what,
                     Console& console) {
  const ScenePtr compiled = loaded.compile();
  const Scene& scene = *compiled;
  const SceneDescription& description = loaded.description();
  const std::string name = vdb::fileName(what.name);
  page.heading("Scene: " + name);
  page.paragraph("The probe starts in " + scene.regions()[scene.startRegion()].name +
                 "; renderer " +
                 (scene.renderer() == RendererKind::kPaper ? "paper" : "constraint") +
                 "; lengths in " + scene.lengthUnit() + ".");

  PictureOptions picture;
  picture.title = name;
  picture.track = what.track;
  picture.image = pictureImage(loaded.images(), "");
  picture.colors = loaded.colors();
  picture.anatomical = !loaded.images().empty();
  const Picture drawn = drawPicture(scene, picture, console);
  page.png(drawn.png, "The scene cut " + drawn.plane.name +
                          (what.track.points.empty() ? "" : ", with the path and the forces"));

  Report sections;
  addRegions(scene, sections);
  addWalls(scene, sections);
  addTransitions(scene, description, sections);
  addMaps(scene, description, sections);
  addWallNotes(scene, sections);
  addStability(scene, what.device, what.rate, sections);
  for (const std::string& note : sections.notes) page.note(note);
  for (const ReportTable& table : sections.tables) page.table(table.title, table.rows);
  page.subheading("The table of states");
  page.svg(transitionPicture(scene, description, name),
           "States and transitions: green arrows are ports, dashed gray ones absent walls");
  if (!loaded.grids().empty()) {
    page.table("Grids", loaded.gridsTable().rows());
    const std::string lost = loaded.lossText();
    if (!lost.empty()) {
      page.subheading("What grids could not hold");
      page.preformatted(lost);
    }
  }
}

}  // namespace palpate::tools
