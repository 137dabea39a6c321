/* show.h - a picture of a result: its load cases or one frame, targets, arrows and the history of a design;
 * of rods their curves (show_rod.h), of drawings their lines (show_drawing.h). */
#pragma once
#include "base/error.h"
#include "view/clip.h"
#include "view/picture.h"

typedef struct ShowDef {
    int frame;        /* of /VTKHDF; -1: the final state of every load case */
    int stills;       /* moments side by side, of rods over each other; 0: 6 of a motion, else none */
    double seconds;   /* how long an animation takes, at 25 moments a second; 0: no animation */
    const char *only; /* one load case; NULL: all */
    const char *
        field; /* magnetization, young, thickness, energy_.., none; NULL: young or thickness if it varies, else |M| */
    ClipPlane
        clip;     /* cuts a shell or solid open at rest, and the eye's side of it is left out; zeros: whole */
    bool arrows;  /* of the magnetisation, as the faces carry it */
    bool history; /* a chart of the objective, if there is one */
    PictureTarget target; /* as it fits; else it must be there */
    double view[3];       /* direction to the eye; zeros: three quarters        */
    int width;            /* pixels; of a drawing those of its paper            */
} ShowDef;

ShowDef show_default(void);

/* What is not SHOW_DONE comes with a sentence. */
typedef enum ShowStatus {
    SHOW_DONE,
    SHOW_HAS_NOT,      /* the result has not what is asked for */
    SHOW_CANNOT_WRITE, /* the picture                          */
} ShowStatus;

/* Writes picture (.png, .svg or .pdf; an animation .webp) from the result file. */
ShowStatus show_result(const char *result, const char *picture, const ShowDef *def, Error *err);
