# Puts the files that make up the HTML viewer into a source file: VIEWER_TEXT. It is made anew where one changes.
set(VIEWER_FOLDER ${CMAKE_CURRENT_LIST_DIR})
function(patina_viewer_file NAME FILE)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${FILE})
    file(READ ${FILE} TEXT)
    set(${NAME} "${TEXT}" PARENT_SCOPE)
endfunction()
patina_viewer_file(PAGE ${VIEWER_FOLDER}/viewer.html)
patina_viewer_file(STYLE ${VIEWER_FOLDER}/viewer.css)
patina_viewer_file(SCRIPT ${VIEWER_FOLDER}/viewer.js)
patina_viewer_file(SURFACE_VERTEX ${VIEWER_FOLDER}/surface.vert)
patina_viewer_file(SURFACE_FRAGMENT ${VIEWER_FOLDER}/surface.frag)
patina_viewer_file(LAMP_VERTEX ${VIEWER_FOLDER}/lamp.vert)
patina_viewer_file(LAMP_FRAGMENT ${VIEWER_FOLDER}/lamp.frag)

# The BRDF is that of the passes.
set(WARD "")
foreach(FILE math/pi math/sampling brdf/ward)
    patina_viewer_file(PART ${patina_SOURCE_DIR}/shaders/lib/${FILE}.glsl)
    string(APPEND WARD "${PART}")
endforeach()
string(REGEX REPLACE "(^|\n)#[^\n]*" "" WARD "${WARD}")
string(REGEX REPLACE "\n( +)const " "\n\\1" WARD "${WARD}")  # in GLSL ES only constants are const

set(VIEWER_TEXT ${CMAKE_CURRENT_BINARY_DIR}/viewer_text.cpp)
configure_file(${VIEWER_FOLDER}/viewer_text.cpp.in ${VIEWER_TEXT} @ONLY)
