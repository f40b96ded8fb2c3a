//! Glare metrics from pictures: position index, source detection, DGP and its siblings. How the picture was made is
//! not known here.
