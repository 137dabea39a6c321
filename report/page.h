/* page.h - the page of a report as the build makes it of page/: cmake/embed.cmake joins its files. */
#pragma once

extern const char report_page_body[];   /* page/page.html */
extern const char report_page_style[];  /* page/page.css */
extern const char report_page_script[]; /* page/NN_*.js, one after the other */
