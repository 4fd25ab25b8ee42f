# Settings of ccache, which scripts that compile source.

# Without, it keeps nothing that is compiled with precompiled headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros
# Compilers know a header that is precompiled by all of its text.
export CCACHE_COMMENTS=true
# The compiler says which files a source includes: nothing is preprocessed for the cache alone, a tenth of what
# compiling into an empty cache costs.
export CCACHE_DEPEND=true
