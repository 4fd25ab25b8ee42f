# For the site: links to public headers become references to them; what else is outside of docs/ is not in the site,
# and links to it become plain text.
s#\[([^][]*)\]\(\.\./((core|bodies|joints|contact|integrators|analysis|testing)/[a-z0-9_]+\.h)\)#[\1](@ref \2)#g
s#\[([^][]*)\]\(\.\./[^()]*\)#\1#g
