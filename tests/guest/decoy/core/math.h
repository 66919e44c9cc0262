/* A file of the parent that is called like one of ours. */
#error "a header of the parent was included"
